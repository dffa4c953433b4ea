// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/point_cloud.hpp>
#include <facula/reconstruct/filter/filter_verdict.hpp>

#include <cstddef>
#include <vector>

namespace facula {

struct StatisticalFilterOptions {
  int neighbours = 16;     ///< points whose mean distance is judged [1], at least 1
  double max_ratio = 2.0;  ///< standard deviations above the mean that are kept [1], above 0
  int num_threads = 0;     ///< 0 = all cores [1]

  void check() const;
};

/// Removes points whose mean distance to their neighbours exceeds the mean over all points by more
/// than max_ratio standard deviations (Rusu 2008), and points that are not finite. Where there are
/// no more points than neighbours all are kept: nothing can be told apart.
FilterVerdict statistical_outliers(const PointCloud& cloud,
                                   const StatisticalFilterOptions& options = {});

/// Indices of the points that statistical_outliers() keeps.
std::vector<std::size_t> statistical_inliers(const PointCloud& cloud,
                                             const StatisticalFilterOptions& options = {});

struct RadiusFilterOptions {
  double radius = 0;       ///< [m], above 0
  int min_neighbours = 4;  ///< other points within the radius that a point needs [1], at least 1
  int num_threads = 0;     ///< 0 = all cores [1]

  void check() const;
};

/// Removes points with fewer than min_neighbours other points at most `radius` away, and points
/// that are not finite.
FilterVerdict radius_outliers(const PointCloud& cloud, const RadiusFilterOptions& options);

}  // namespace facula
