// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/point_cloud.hpp>
#include <facula/reconstruct/measure/plane.hpp>

#include <cstddef>
#include <vector>

namespace facula {

/// The largest of the pieces into which `indices` (points of the cloud near the plane) fall when
/// points in neighbouring cells of a square grid on the plane belong together. `cell` [m], above 0.
/// Keeps the order of the indices.
std::vector<std::size_t> largest_piece(const PointCloud& cloud,
                                       const std::vector<std::size_t>& indices,
                                       const Plane& plane,
                                       double cell);

}  // namespace facula
