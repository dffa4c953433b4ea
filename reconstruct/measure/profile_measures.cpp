// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/median.hpp>
#include <facula/reconstruct/measure/profile_measures.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Eigenvalues>

namespace facula {
namespace {

using Points = std::vector<Eigen::Vector2d>;

Points points_of(const Points& profile, const ProfileSpan& span, const char* name) {
  require(span.first < span.last && span.last <= profile.size(),
          "the ",
          name,
          "'s columns ",
          span.first,
          " to ",
          span.last,
          " leave the profile of ",
          profile.size());
  const auto begin = profile.begin();
  return {begin + static_cast<std::ptrdiff_t>(span.first),
          begin + static_cast<std::ptrdiff_t>(span.last)};
}

Points seen_points(const Points& points, const char* name) {
  Points seen;
  for (const Eigen::Vector2d& p : points) {
    if (p.allFinite()) seen.push_back(p);
  }
  require(seen.size() >= 5, "expected at least 5 points seen on the ", name, ", got ", seen.size());
  return seen;
}

struct Line {
  Eigen::Vector2d mean;
  Eigen::Vector2d normal;  ///< upwards

  double distance(const Eigen::Vector2d& p) const { return normal.dot(p - mean); }
};

Line line_through(const Points& points) {
  Line line{Eigen::Vector2d::Zero(), {}};
  for (const Eigen::Vector2d& p : points) line.mean += p;
  line.mean /= static_cast<double>(points.size());
  Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
  for (const Eigen::Vector2d& p : points) spread += (p - line.mean) * (p - line.mean).transpose();
  line.normal = Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(spread).eigenvectors().col(0);
  if (line.normal.y() < 0) line.normal = -line.normal;
  return line;
}

/// Drops what lies farther than 3 robust standard deviations from the median distance.
void drop_outliers(Points& points, const Line& line) {
  std::vector<double> distances;
  for (const Eigen::Vector2d& p : points) distances.push_back(line.distance(p));
  std::vector<double> sorted = distances;
  const double middle = median(sorted);
  for (double& d : sorted) d = std::abs(d - middle);
  const double limit = 3 * 1.4826 * median(sorted) + 1e-12;
  Points kept;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (std::abs(distances[i] - middle) <= limit) kept.push_back(points[i]);
  }
  if (kept.size() >= 5) points = std::move(kept);
}

}  // namespace

double polygon_ratio(int sides) {
  require(sides >= 3, "expected a polygon of at least 3 sides, got ", sides);
  return sides % 2 == 0 ? std::tan(std::numbers::pi / sides)
                        : 2 * std::tan(std::numbers::pi / (2.0 * sides));
}

double polygon_side(int sides, double height) {
  require(height > 0 && std::isfinite(height), "expected a height above 0 mm, got ", 1000 * height);
  return height * polygon_ratio(sides);
}

StepMeasure measure_step(const Points& profile, const ProfileSpan& base, const ProfileSpan& top) {
  return measure_step(points_of(profile, base, "base"), points_of(profile, top, "top"));
}

StepMeasure measure_step(const Points& base, const Points& top) {
  Points below = seen_points(base, "base");
  Points above = seen_points(top, "top");
  drop_outliers(below, line_through(below));
  const Line line = line_through(below);
  drop_outliers(above, line);
  StepMeasure step{.base_points = below.size(), .top_points = above.size()};
  double base_squares = 0;
  for (const Eigen::Vector2d& p : below) base_squares += std::pow(line.distance(p), 2);
  for (const Eigen::Vector2d& p : above) {
    step.thickness += line.distance(p) / static_cast<double>(above.size());
  }
  double top_squares = 0;
  double reach = 0;
  for (const Eigen::Vector2d& p : above) {
    top_squares += std::pow(line.distance(p) - step.thickness, 2);
    reach += (p - line.mean).x() / static_cast<double>(above.size());
  }
  double spread = 0;
  for (const Eigen::Vector2d& p : below) spread += std::pow((p - line.mean).x(), 2);
  const auto n_base = static_cast<double>(below.size());
  const auto n_top = static_cast<double>(above.size());
  step.base_scatter = std::sqrt(base_squares / (n_base - 2));
  step.top_scatter = std::sqrt(top_squares / (n_top - 1));
  // The base's line is extrapolated to below the top.
  step.sigma =
      std::sqrt(step.top_scatter * step.top_scatter / n_top +
                step.base_scatter * step.base_scatter * (1 / n_base + reach * reach / spread));
  return step;
}

}  // namespace facula
