// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/median.hpp>
#include <facula/acquire/core/random.hpp>
#include <facula/reconstruct/measure/sphere.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include <Eigen/Dense>

namespace facula {
namespace {

class SphereModel : public PrimitiveModel {
 public:
  explicit SphereModel(const Sphere& sphere) : sphere_(sphere) {}

  const Sphere& sphere() const { return sphere_; }

  int parameters() const override { return 4; }

  double distance(const Eigen::Vector3d& x,
                  Eigen::Vector3d& normal,
                  Eigen::VectorXd& gradient) const override {
    const Eigen::Vector3d d = x - sphere_.center;
    const double length = d.norm();
    normal = length > 0 ? Eigen::Vector3d(d / length) : Eigen::Vector3d::UnitZ();
    gradient << -normal, -1;
    return length - sphere_.radius;
  }

  void move(const Eigen::VectorXd& step) override {
    before_ = sphere_;
    sphere_.center += step.head<3>();
    sphere_.radius += step(3);
  }

  void undo() override { sphere_ = before_; }

 private:
  Sphere sphere_;
  Sphere before_;
};

/// Least squares of |x|^2 = 2 c.x + k about the points' mean; nothing when they lie in one plane.
std::optional<Sphere> algebraic_sphere(const std::vector<Eigen::Vector3d>& points) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& x : points) mean += x / static_cast<double>(points.size());
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  double squares = 0;
  for (const Eigen::Vector3d& x : points) {
    const Eigen::Vector3d d = x - mean;
    scatter += d * d.transpose();
    right += d * d.squaredNorm();
    squares += d.squaredNorm() / static_cast<double>(points.size());
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(scatter);
  if (!(solver.eigenvalues()(0) > 1e-10 * solver.eigenvalues()(2))) return std::nullopt;
  const Eigen::Vector3d center = scatter.ldlt().solve(right) / 2;
  return Sphere{mean + center, std::sqrt(center.squaredNorm() + squares)};
}

std::vector<Eigen::Vector3d> finite_points(const PointCloud& cloud,
                                           const std::vector<std::size_t>& indices) {
  std::vector<Eigen::Vector3d> points;
  for (const std::size_t i : indices) {
    require(i < cloud.size(), "expected points of a cloud of ", cloud.size(), ", got number ", i);
    if (cloud.points[i].allFinite()) points.emplace_back(cloud.points[i].cast<double>());
  }
  return points;
}

std::vector<std::size_t> points_on(const PointCloud& cloud, const Sphere& sphere, double within) {
  std::vector<std::size_t> result;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Eigen::Vector3d x = cloud.points[i].cast<double>();
    if (std::abs(sphere.signed_distance(x)) <= within) result.push_back(i);
  }
  return result;
}

/// Enough points to judge tries by; all where there are few.
std::vector<std::size_t> judges(const std::vector<std::size_t>& indices, Random& random) {
  constexpr std::size_t kMost = 5000;
  if (indices.size() <= kMost) return indices;
  std::vector<std::size_t> drawn;
  for (std::size_t i = 0; i < kMost; ++i) drawn.push_back(indices[random.below(indices.size())]);
  return drawn;
}

std::size_t count_on(const PointCloud& cloud,
                     const std::vector<std::size_t>& indices,
                     const Sphere& sphere,
                     double within) {
  std::size_t count = 0;
  for (const std::size_t i : indices) {
    const double away = sphere.signed_distance(cloud.points[i].cast<double>());
    count += std::abs(away) <= within ? 1 : 0;
  }
  return count;
}

std::optional<Sphere> best_of_trials(const PointCloud& cloud, const ShapeSearchOptions& options) {
  Random random(options.seed);
  std::vector<std::size_t> finite;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (cloud.points[i].allFinite()) finite.push_back(i);
  }
  require(finite.size() >= 4, "a sphere needs at least 4 points, the cloud has ", finite.size());
  const std::vector<std::size_t> judging = judges(finite, random);
  std::optional<Sphere> best;
  std::size_t most = 0;
  double trials = options.trials;
  for (int t = 0; t < trials; ++t) {
    std::vector<Eigen::Vector3d> four(4);
    for (Eigen::Vector3d& p : four) {
      p = cloud.points[finite[random.below(finite.size())]].cast<double>();
    }
    const std::optional<Sphere> sphere = algebraic_sphere(four);
    if (!sphere || sphere->radius < options.min_radius || sphere->radius > options.max_radius) {
      continue;
    }
    const std::size_t count = count_on(cloud, judging, *sphere, options.inlier_distance);
    if (count <= most) continue;
    most = count;
    best = sphere;
    // Enough tries that four good points were drawn once in 1 - 1e-6 of searches.
    const double good =
        std::pow(static_cast<double>(count) / static_cast<double>(judging.size()), 4);
    if (good > 0.999) break;
    trials = std::min(trials, std::log(1e-6) / std::log(1 - good));
  }
  return best;
}

}  // namespace

SphereFit fit_sphere(const PointCloud& cloud,
                     const std::vector<std::size_t>& indices,
                     const PrimitiveFitOptions& options) {
  const std::vector<Eigen::Vector3d> points = finite_points(cloud, indices);
  require(points.size() >= 4, "a sphere needs at least 4 points, got ", points.size());
  const std::optional<Sphere> start = algebraic_sphere(points);
  require(start.has_value(),
          "the ",
          points.size(),
          " points lie in one plane, so they decide no sphere; scan more of it");
  SphereModel model(*start);
  SphereFit fit;
  fit.quality = fit_primitive(cloud, indices, model, options);
  fit.sphere = model.sphere();
  fit.center_covariance = fit.quality.covariance.topLeftCorner<3, 3>();
  fit.radius_sigma = std::sqrt(fit.quality.covariance(3, 3));
  return fit;
}

void ShapeSearchOptions::check() const {
  require(inlier_distance > 0 && std::isfinite(inlier_distance),
          "expected an inlier distance above 0 mm, got ",
          1000 * inlier_distance);
  require(min_radius >= 0 && max_radius > min_radius,
          "expected a least radius of 0 mm or more and a greater largest one, got ",
          1000 * min_radius,
          " and ",
          1000 * max_radius);
  require(min_points >= 10, "expected shapes of 10 points or more, got ", min_points);
  require(trials >= 1, "expected 1 trial or more, got ", trials);
}

void ShapeSearchOptions::require_found(const char* shape,
                                       std::size_t found,
                                       std::size_t points) const {
  require(found >= min_points,
          "expected a ",
          shape,
          " of ",
          min_points,
          " points or more among ",
          points,
          ", the best has ",
          found,
          "; raise the inlier distance or name the radius sought");
}

double trimmed_distance(std::vector<double> distances, double inlier_distance) {
  constexpr double kReach = 5;     // robust standard deviations
  constexpr double kLeast = 1e-6;  // [m]; floats hold no finer distances
  for (double& d : distances) d = std::abs(d);
  const double reach = kReach * 1.4826 * median(distances);
  return std::min(inlier_distance, std::max(kLeast, reach));
}

FoundSphere find_sphere(const PointCloud& cloud, const ShapeSearchOptions& options) {
  options.check();
  cloud.check();
  const std::optional<Sphere> start = best_of_trials(cloud, options);
  FoundSphere found;
  if (start) found.indices = points_on(cloud, *start, options.inlier_distance);
  options.require_found("sphere", found.indices.size(), cloud.size());
  for (int round = 0; round < 4; ++round) {
    found.fit = fit_sphere(cloud, found.indices);
    std::vector<double> away;
    for (const std::size_t i : found.indices) {
      away.push_back(found.fit.sphere.signed_distance(cloud.points[i].cast<double>()));
    }
    const double within = trimmed_distance(away, options.inlier_distance);
    found.indices = points_on(cloud, found.fit.sphere, within);
  }
  found.fit = fit_sphere(cloud, found.indices);
  return found;
}

}  // namespace facula
