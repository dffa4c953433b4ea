// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/point_cloud.hpp>
#include <facula/reconstruct/filter/outlier_filters.hpp>

namespace facula {

/// One point per occupied voxel of edge length `voxel` [m]: the mean of its points and attributes
/// (weights 1/sigma^2 where sigma is given; normals renormalised), ordered by voxel. Valid for
/// clouds up to 2^21 voxels wide in every direction; throws Error beyond.
PointCloud thin_by_voxel(const PointCloud& cloud, double voxel);

}  // namespace facula
