// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/reconstruct/measure/ransac_plane.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace facula {
namespace {

constexpr int kTries = 300;             // draws for the second and third point of a triple
constexpr double kMissedShare = 1e-4;   // chance of ending before the best plane was tried
constexpr double kNeighbourhood = 0.3;  // radius of a triple over the spread of the points
constexpr double kPurity = 0.5;         // share of a point's neighbourhood on the point's own plane

/// Points about their centroid, one column per axis: the count below then runs in vector registers.
struct Columns {
  Eigen::Vector3d centroid = Eigen::Vector3d::Zero();
  Eigen::ArrayXf x, y, z;

  explicit Columns(const std::vector<Eigen::Vector3f>& points) {
    const auto n = static_cast<Eigen::Index>(points.size());
    for (const Eigen::Vector3f& p : points) centroid += p.cast<double>() / double(n);
    x.resize(n);
    y.resize(n);
    z.resize(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      const Eigen::Vector3d p = points[static_cast<std::size_t>(i)].cast<double>() - centroid;
      x[i] = static_cast<float>(p.x());
      y[i] = static_cast<float>(p.y());
      z[i] = static_cast<float>(p.z());
    }
  }

  Eigen::Vector3f point(std::uint64_t i) const {
    const auto row = static_cast<Eigen::Index>(i);
    return {x[row], y[row], z[row]};
  }

  double spread() const { return std::sqrt(double((x.square() + y.square() + z.square()).mean())); }

  Eigen::Index count_near(const Eigen::Vector3f& normal, float offset, float reach) const {
    return ((normal.x() * x + normal.y() * y + normal.z() * z - offset).abs() <= reach).count();
  }
};

using Triple = std::array<Eigen::Vector3f, 3>;

/// Three points, the second and third within `radius` of the first; nothing when too few tries hit.
std::optional<Triple> draw_triple(const Columns& columns, float radius, Random& random) {
  const auto count = static_cast<std::uint64_t>(columns.x.size());
  Triple triple{columns.point(random.below(count))};
  std::size_t found = 1;
  for (int tries = 0; tries < kTries && found < 3; ++tries) {
    triple[found] = columns.point(random.below(count));
    if ((triple[found] - triple[0]).norm() <= radius) ++found;
  }
  if (found < 3) return {};
  return triple;
}

/// Unit normal of the triple's plane; nothing for needles, whose plane turns freely about them.
std::optional<Eigen::Vector3f> normal_of(const Triple& triple) {
  const Eigen::Vector3f a = triple[1] - triple[0];
  const Eigen::Vector3f b = triple[2] - triple[0];
  const Eigen::Vector3f normal = a.cross(b);
  const float longest = std::max({a.squaredNorm(), b.squaredNorm(), (b - a).squaredNorm()});
  if (!(normal.norm() > 0.05F * longest)) return {};
  return normal.normalized();
}

/// Trials after which a plane with this share of the points was drawn almost surely.
double trials_needed(double share) {
  const double hit = share * kPurity * kPurity;
  return hit < 1 ? std::log(kMissedShare) / std::log(1 - hit) : 1;
}

}  // namespace

std::optional<Plane> ransac_plane(const std::vector<Eigen::Vector3f>& points,
                                  const RansacPlaneOptions& options,
                                  Random& random) {
  if (points.size() < 3) return {};
  const Columns columns(points);
  const double radius = std::max(kNeighbourhood * columns.spread(), 10 * options.inlier_distance);
  Plane best;
  Eigen::Index most = 0;
  double trials = options.max_trials;
  for (int trial = 0; trial < trials; ++trial) {
    const auto triple = draw_triple(columns, static_cast<float>(radius), random);
    const auto normal = triple ? normal_of(*triple) : std::nullopt;
    if (!normal) continue;
    const float offset = normal->dot((*triple)[0]);
    const auto count =
        columns.count_near(*normal, offset, static_cast<float>(options.inlier_distance));
    if (count <= most) continue;
    most = count;
    const Eigen::Vector3d n = normal->cast<double>().normalized();
    best = {n, double(offset) + n.dot(columns.centroid)};
    trials = std::min(trials, trials_needed(double(most) / double(points.size())));
  }
  if (most < 3) return {};
  return best;
}

}  // namespace facula
