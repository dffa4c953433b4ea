// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/known_sigma.hpp>
#include <facula/acquire/core/parallel.hpp>
#include <facula/reconstruct/register/point_pairs.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/LU>

namespace facula {
namespace {

constexpr double kLeastCosine = 0.2;     // a grazing ray makes a point neither exact nor worthless
constexpr double kVarianceRatio = 1e-3;  // across to along the surface (Segal et al. 2009)
constexpr double kSharedError = 0.2;     // share of a variance that a mean over more points keeps
constexpr double kLeastVarianceRatio = 1e-5;
constexpr float kRounding = 1e-5F;  // of a distance in single precision, generously [1]

/// Cosine between a point's ray and its normal; 1 where the ray is unknown.
double cosine_of_incidence(const PointCloud& cloud, std::size_t i) {
  if (cloud.sensor_origin.empty()) return 1;
  const Eigen::Vector3f ray = cloud.points[i] - cloud.sensor_origin[i];
  const float length = ray.norm();
  if (!(length > 0)) return 1;
  return std::max<double>(std::abs(ray.dot(cloud.normals[i])) / length, kLeastCosine);
}

double variance_along(const PyramidLevel& level) {
  return std::pow(level.voxel / 2, 2);
}

/// Covariance of a point that spreads along its tangent plane and little across it.
Eigen::Matrix3d plane_like(const Eigen::Vector3d& normal, double along, double across) {
  return along * Eigen::Matrix3d::Identity() - (along - across) * normal * normal.transpose();
}

}  // namespace

PairFinder::PairFinder(const PyramidLevel& source,
                       const PyramidLevel& target,
                       bool sided,
                       const PairOptions& options)
    : source_(source),
      target_(target),
      options_(options),
      sided_(sided),
      min_cosine_(std::cos(options.max_normal_angle)),
      source_along_(variance_along(source)),
      target_along_(variance_along(target)),
      found_(source.cloud.size()) {
  const bool use_sigma = knows_sigma(source.cloud) && knows_sigma(target.cloud);
  source_quality_ = qualities(source, use_sigma);
  target_quality_ = qualities(target, use_sigma);
}

/// A stated sigma lies along the ray; only its part along the normal moves the surface. Unless both
/// scans know theirs, all points vary alike, and those seen aslant are trusted less (as by Turk and
/// Levoy 1994): their errors are more often gross than wide.
std::vector<PairFinder::PointQuality> PairFinder::qualities(const PyramidLevel& level,
                                                            bool use_sigma) {
  const double along = variance_along(level);
  std::vector<PointQuality> qualities(level.cloud.size());
  for (std::size_t i = 0; i < qualities.size(); ++i) {
    const double cosine = cosine_of_incidence(level.cloud, i);
    const double across =
        use_sigma ? std::pow(level.cloud.sigma[i] * cosine, 2)
                  : kVarianceRatio * along * (kSharedError + (1 - kSharedError) / level.merged[i]);
    qualities[i].across = static_cast<float>(std::max(across, kLeastVarianceRatio * along));
    if (!use_sigma) qualities[i].doubt = static_cast<float>(1 / (cosine * cosine));
  }
  return qualities;
}

std::vector<PointPair> PairFinder::find(const RigidTransform& target_from_source,
                                        double max_distance) {
  const Eigen::Matrix3d rotation = target_from_source.rotation.toRotationMatrix();
  std::vector<PointPair> pairs(found_.size());
  std::vector<char> is_pair(found_.size(), 0);
  const auto body = [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      pairs[i].point =
          rotation * source_.cloud.points[i].cast<double>() + target_from_source.translation;
      is_pair[i] = match(i, rotation, max_distance, pairs[i]) ? 1 : 0;
    }
  };
  parallel_for(found_.size(), body, {.num_threads = options_.num_threads, .chunk = 512});
  std::size_t kept = 0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (is_pair[i] == 0) continue;
    if (kept != i) pairs[kept] = pairs[i];
    ++kept;
  }
  pairs.resize(kept);
  return pairs;
}

bool PairFinder::match(std::size_t i,
                       const Eigen::Matrix3d& rotation,
                       double bound,
                       PointPair& pair) {
  if (!find_nearest(pair.point.cast<float>(), static_cast<float>(bound), found_[i])) return false;
  pair.source = static_cast<std::uint32_t>(i);
  pair.target = found_[i].nearest;
  pair.offset = pair.point - target_.cloud.points[pair.target].cast<double>();
  pair.distance = pair.offset.norm();
  if (!(pair.distance <= bound)) return false;
  pair.source_normal = rotation * source_.cloud.normals[i].cast<double>();
  pair.target_normal = target_.cloud.normals[pair.target].cast<double>();
  if (!normals_agree(pair)) return false;
  weigh(pair);
  return true;
}

/// False when no target point can be within the bound.
bool PairFinder::find_nearest(const Eigen::Vector3f& query, float bound, Found& found) const {
  if (found.distance >= 0) {
    const float moved = (query - found.query).norm() * (1 + kRounding);
    if (found.distance * (1 - kRounding) - moved > bound) return false;
    const float now = (query - target_.cloud.points[found.nearest]).norm();
    if (now * (1 + kRounding) < found.second * (1 - kRounding) - moved) return true;
  }
  if (!query.allFinite()) return false;
  std::array<NearestNeighbours::Neighbour, 2> nearest;
  const std::size_t count = target_.tree.nearest(query, nearest);
  if (count == 0) return false;
  found.query = query;
  found.nearest = static_cast<std::uint32_t>(nearest[0].index);
  found.distance = std::sqrt(nearest[0].squared_distance);
  found.second =
      count > 1 ? std::sqrt(nearest[1].squared_distance) : std::numeric_limits<float>::infinity();
  return true;
}

/// Turns the source normal to the target's side where sides are unknown.
bool PairFinder::normals_agree(PointPair& pair) const {
  double cosine = pair.source_normal.dot(pair.target_normal);
  if (!sided_ && cosine < 0) {
    pair.source_normal = -pair.source_normal;
    cosine = -cosine;
  }
  return cosine >= min_cosine_ && cosine > 0;  // not where a normal is unknown (zero)
}

void PairFinder::weigh(PointPair& pair) const {
  const PointQuality& source = source_quality_[pair.source];
  const PointQuality& target = target_quality_[pair.target];
  const double source_across = source.across;
  const double target_across = target.across;
  double variance = source_across + target_across;
  Eigen::Vector3d& normal = pair.normal;
  normal = pair.target_normal;
  if (options_.method == PairMethod::kPointToPlane) {
    // The tangent plane is as wrong beside its point as the two normals disagree.
    variance += (pair.offset.squaredNorm() - std::pow(normal.dot(pair.offset), 2)) *
                (1 - std::pow(normal.dot(pair.source_normal), 2)) / 2;
    pair.weight = normal * normal.transpose() / variance;
  } else {
    normal = (pair.source_normal + pair.target_normal).normalized();
    const Eigen::Matrix3d spread = plane_like(pair.source_normal, source_along_, source_across) +
                                   plane_like(pair.target_normal, target_along_, target_across);
    pair.weight = spread.inverse();
    variance = normal.dot(spread * normal);
  }
  pair.weight *= 2 / (double(source.doubt) + double(target.doubt));
  pair.plane_distance = normal.dot(pair.offset);
  pair.residual = pair.plane_distance / std::sqrt(variance);
}

}  // namespace facula
