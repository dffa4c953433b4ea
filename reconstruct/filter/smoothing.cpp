// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/known_sigma.hpp>
#include <facula/acquire/core/parallel.hpp>
#include <facula/reconstruct/filter/line_of_sight.hpp>
#include <facula/reconstruct/filter/nearest_neighbours.hpp>
#include <facula/reconstruct/filter/point_spacing.hpp>
#include <facula/reconstruct/filter/smoothing.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace facula {
namespace {

constexpr double kReach = 2.5;         // of the weights, in radii: 4 % of the greatest
constexpr double kLeastWidth = 0.1;    // variance across over along, of neighbours in a plane
constexpr double kLeastCosine = 0.17;  // steeper rays count as 80 degrees

using Row = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 6, 1>;
using Square = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 6, 6>;

Row monomials(double u, double v, int order) {
  Row row(order == 1 ? 3 : 6);
  if (order == 1) {
    row << 1, u, v;
  } else {
    row << 1, u, v, u * u, u * v, v * v;
  }
  return row;
}

/// Where a point lands.
struct Landing {
  Eigen::Vector3d normal;
  double height = 0;  ///< of the surface above the point, along the normal [m]
  double sigma = 0;   ///< of that height [m]
};

class Smoother {
 public:
  Smoother(const PointCloud& cloud, const SmoothingOptions& options)
      : cloud_(cloud),
        options_(options),
        has_sigma_(options.default_sigma > 0 || knows_sigma(cloud)),
        tree_(cloud.points, options.num_threads) {}

  const NearestNeighbours& tree() const { return tree_; }

  std::optional<Landing> land(std::size_t i) const {
    const auto near = tree_.within(cloud_.points[i], float(kReach * options_.radius));
    const std::size_t coefficients = options_.order == 1 ? 3 : 6;
    if (near.size() < 2 * coefficients) return std::nullopt;
    const auto plane = plane_axes(i, near);
    if (!plane) return std::nullopt;
    const Eigen::Matrix3d& axes = *plane;
    const Eigen::Vector3d normal = axes.col(0);
    Square squares = Square::Zero(Eigen::Index(coefficients), Eigen::Index(coefficients));
    Square spread = squares;  // of the weighted noise
    Row right = Row::Zero(Eigen::Index(coefficients));
    double squared = 0;
    double weights = 0;
    for (const auto& n : near) {
      const Eigen::Vector3d d = (cloud_.points[n.index] - cloud_.points[i]).cast<double>();
      const Row row = monomials(d.dot(axes.col(1)) / options_.radius,
                                d.dot(axes.col(2)) / options_.radius,
                                options_.order);
      const double sigma = normal_sigma(n.index, normal);
      const double w = gauss(n.squared_distance) / (sigma * sigma);
      const double z = d.dot(normal);
      squares += w * row * row.transpose();
      spread += w * w * sigma * sigma * row * row.transpose();
      right += w * z * row;
      squared += w * z * z;
      weights += w * sigma * sigma;
    }
    const Eigen::LDLT<Square> solver(squares);
    const Row surface = solver.solve(right);
    const Row share = solver.solve(Row::Unit(Eigen::Index(coefficients), 0));
    Landing landing{normal, surface[0], std::sqrt(std::max(0.0, share.dot(spread * share)))};
    if (!std::isfinite(landing.height) || !std::isfinite(landing.sigma)) return std::nullopt;
    // The mean weighted square of the residuals; the fit took its share of it.
    const double freedom = weights - Square(solver.solve(spread)).trace();
    if (!(freedom > 0)) return std::nullopt;
    const double misfit = std::max(0.0, squared - right.dot(surface)) / freedom;
    if (has_sigma_ && misfit > options_.max_misfit) return std::nullopt;
    // Without sigmas the scatter about the surface tells the noise.
    if (!has_sigma_) landing.sigma *= std::sqrt(misfit);
    return landing;
  }

  /// The share of a sigma along the ray that lies along the normal.
  double cosine(std::size_t i, const Eigen::Vector3d& normal) const {
    if (cloud_.sensor_origin.empty()) return 1;
    const Eigen::Vector3d ray = (cloud_.sensor_origin[i] - cloud_.points[i]).cast<double>();
    return std::max(kLeastCosine, std::abs(normal.dot(ray.stableNormalized())));
  }

 private:
  double gauss(double squared_distance) const {
    return std::exp(-0.5 * squared_distance / (options_.radius * options_.radius));
  }

  double normal_sigma(std::size_t i, const Eigen::Vector3d& normal) const {
    if (!has_sigma_) return 1;
    const bool own = !cloud_.sigma.empty() && is_known_sigma(cloud_.sigma[i]);
    return (own ? double(cloud_.sigma[i]) : options_.default_sigma) * cosine(i, normal);
  }

  /// Columns: normal, two directions in the plane of the neighbours. Nothing where they lie along a
  /// line, as those of a single stripe do: they say nothing of the surface across it.
  std::optional<Eigen::Matrix3d> plane_axes(
      std::size_t i, const std::vector<NearestNeighbours::Neighbour>& near) const {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
    double weights = 0;
    for (const auto& n : near) {
      const Eigen::Vector3d d = (cloud_.points[n.index] - cloud_.points[i]).cast<double>();
      const double w = gauss(n.squared_distance);
      sum += w * d;
      squares += w * d * d.transpose();
      weights += w;
    }
    const Eigen::Matrix3d scatter = squares - sum * sum.transpose() / weights;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(scatter);
    if (!(solver.eigenvalues()[1] > kLeastWidth * solver.eigenvalues()[2])) return std::nullopt;
    return solver.eigenvectors();
  }

  const PointCloud& cloud_;
  const SmoothingOptions& options_;
  bool has_sigma_;  // of every point, its own or the default
  NearestNeighbours tree_;
};

/// Turned to the side that the point was seen from.
Eigen::Vector3f facing(const PointCloud& cloud, std::size_t i, const Eigen::Vector3d& normal) {
  const Eigen::Vector3f n = normal.cast<float>();
  return n.dot(towards_sensor(cloud, i)) < 0 ? Eigen::Vector3f(-n) : n;
}

/// A radius that takes in thousands of points smooths nothing local and takes forever.
void require_local(const PointCloud& cloud, const NearestNeighbours& tree, double reach) {
  constexpr std::size_t kSamples = 64;
  constexpr std::size_t kMost = 5000;
  std::size_t worst = 0;
  const std::size_t step = std::max<std::size_t>(1, cloud.size() / kSamples);
  for (std::size_t i = 0; i < cloud.size(); i += step) {
    if (!cloud.points[i].allFinite()) continue;
    worst = std::max(worst, tree.within(cloud.points[i], float(reach)).size());
  }
  require(worst <= kMost,
          "expected a smoothing radius that takes in at most ",
          kMost,
          " neighbours of a point, got one of ",
          reach / kReach,
          " m that takes in ",
          worst,
          "; give a smaller one or thin the points first");
}

}  // namespace

void SmoothingOptions::check() const {
  require(radius > 0 && std::isfinite(radius), "radius is ", radius, " m; give a length above 0");
  require(order == 1 || order == 2, "order is ", order, "; give 1 (plane) or 2 (paraboloid)");
  require(max_misfit > 0, "max_misfit is ", max_misfit, "; give a number above 0");
  require(default_sigma >= 0, "default_sigma is ", default_sigma, " m; give a length of 0 or more");
  require(num_threads >= 0, "num_threads is ", num_threads, "; give 0 (all cores) or more");
}

SmoothedCloud smooth(const PointCloud& cloud, const SmoothingOptions& options) {
  options.check();
  cloud.check();
  SmoothedCloud result{cloud};
  PointCloud& out = result.cloud;
  out.normals.resize(cloud.size(), Eigen::Vector3f::Zero());
  out.sigma.resize(cloud.size(), float(options.default_sigma));
  constexpr float kNot = std::numeric_limits<float>::quiet_NaN();
  std::vector<float> move(cloud.size(), kNot);
  std::vector<float> ratio(cloud.size(), kNot);
  const Smoother smoother(cloud, options);
  require_local(cloud, smoother.tree(), kReach * options.radius);
  const auto land = [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (!cloud.points[i].allFinite()) continue;
      const auto landing = smoother.land(i);
      if (!landing) continue;
      out.points[i] =
          (cloud.points[i].cast<double>() + landing->height * landing->normal).cast<float>();
      out.normals[i] = facing(cloud, i, landing->normal);
      out.sigma[i] = float(landing->sigma / smoother.cosine(i, landing->normal));
      move[i] = float(std::abs(landing->height));
      if (!cloud.sigma.empty() && is_known_sigma(cloud.sigma[i])) {
        ratio[i] = out.sigma[i] / cloud.sigma[i];
      }
    }
  };
  parallel_for(cloud.size(), land, {.num_threads = options.num_threads, .chunk = 256});
  result.moved =
      std::size_t(std::count_if(move.begin(), move.end(), [](float m) { return !std::isnan(m); }));
  result.median_move = quantile(std::move(move), 0.5);
  result.median_sigma_ratio = quantile(std::move(ratio), 0.5);
  return result;
}

}  // namespace facula
