// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/parallel.hpp>
#include <facula/reconstruct/filter/nearest_neighbours.hpp>
#include <facula/reconstruct/filter/outlier_filters.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace facula {
namespace {

constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();

/// Mean distance of every point to its k nearest other points [m]; NaN where it is not finite.
std::vector<float> mean_distances(const PointCloud& cloud,
                                  const NearestNeighbours& tree,
                                  const StatisticalFilterOptions& options) {
  std::vector<float> mean(cloud.size(), kUnknown);
  const auto measure = [&](std::size_t i, std::span<const NearestNeighbours::Neighbour> found) {
    double sum = 0;  // the point itself adds nothing
    for (const auto& neighbour : found) sum += std::sqrt(neighbour.squared_distance);
    mean[i] = static_cast<float>(sum / options.neighbours);
  };
  tree.for_all_nearest(options.neighbours + 1, measure, options.num_threads);
  return mean;
}

/// Mean plus max_ratio standard deviations of the distances that are known.
double limit_of(const std::vector<float>& distances, double max_ratio) {
  double sum = 0;
  double squares = 0;
  double n = 0;
  for (const float d : distances) {
    if (std::isnan(d)) continue;
    sum += d;
    squares += double(d) * d;
    ++n;
  }
  const double variance = n > 1 ? (squares - sum * sum / n) / (n - 1) : 0;
  return sum / n + max_ratio * std::sqrt(std::max(0.0, variance));
}

}  // namespace

void StatisticalFilterOptions::check() const {
  require(neighbours >= 1, "neighbours is ", neighbours, "; give at least 1");
  require(max_ratio > 0 && std::isfinite(max_ratio),
          "max_ratio is ",
          max_ratio,
          "; give a number of standard deviations above 0");
  require(num_threads >= 0, "num_threads is ", num_threads, "; give 0 (all cores) or more");
}

FilterVerdict statistical_outliers(const PointCloud& cloud,
                                   const StatisticalFilterOptions& options) {
  options.check();
  cloud.check();
  FilterVerdict verdict(cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (!cloud.points[i].allFinite()) verdict.remove(i, Removal::kNotFinite);
  }
  if (verdict.count(Removal::kKept) <= static_cast<std::size_t>(options.neighbours)) {
    return verdict;
  }
  const NearestNeighbours tree(cloud.points, options.num_threads);
  const std::vector<float> mean = mean_distances(cloud, tree, options);
  const double limit = limit_of(mean, options.max_ratio);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (mean[i] > limit) verdict.remove(i, Removal::kStatistical);
  }
  return verdict;
}

std::vector<std::size_t> statistical_inliers(const PointCloud& cloud,
                                             const StatisticalFilterOptions& options) {
  return statistical_outliers(cloud, options).kept();
}

}  // namespace facula
