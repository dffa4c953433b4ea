// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/point_cloud.hpp>

#include <cstddef>
#include <vector>

namespace facula {

struct StatisticalFilterOptions {
  int neighbours = 16;     ///< points whose mean distance is judged [1], at least 1
  double max_ratio = 2.0;  ///< standard deviations above the mean that are kept [1], above 0

  void check() const;
};

/// Indices of the points whose mean distance to their neighbours is ordinary (Rusu 2008).
std::vector<std::size_t> statistical_inliers(const PointCloud& cloud,
                                             const StatisticalFilterOptions& options = {});

/// One point per occupied voxel of edge length `voxel` [m]: the mean of its points and attributes
/// (weights 1/sigma^2 where sigma is given; normals renormalised), ordered by voxel. Valid for
/// clouds up to 2^21 voxels wide in every direction; throws Error beyond.
PointCloud thin_by_voxel(const PointCloud& cloud, double voxel);

}  // namespace facula
