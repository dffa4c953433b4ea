// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/point_cloud.hpp>
#include <facula/reconstruct/filter/outlier_filters.hpp>

#include <cstdint>
#include <limits>
#include <vector>

namespace facula {

constexpr std::uint32_t kNoVoxel = std::numeric_limits<std::uint32_t>::max();

/// One point per occupied voxel of edge length `voxel` [m]: the mean of its points and attributes
/// (weights 1/sigma^2 of those points of a voxel that know their sigma; where none does, all count
/// alike and the mean's sigma stays unknown, 0; normals renormalised), ordered by voxel. Valid for
/// clouds up to 2^21 voxels wide in every direction; throws Error beyond. `voxel_of`, when given,
/// receives for every point of the cloud the index of the point it went into, kNoVoxel for those
/// that are not finite.
PointCloud thin_by_voxel(const PointCloud& cloud,
                         double voxel,
                         std::vector<std::uint32_t>* voxel_of = nullptr);

}  // namespace facula
