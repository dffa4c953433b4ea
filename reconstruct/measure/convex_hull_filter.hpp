// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace facula {

/// Indices, in order, of points among which are all corners of the convex hull: those proven to lie
/// inside it are left out. Works in the points' principal axes, on a grid over the two long ones
/// with the highest and the lowest point of each cell; made for the flat clouds of surfaces, where
/// it leaves a few in a hundred. Throws Error when a point is not finite.
std::vector<std::uint32_t> hull_candidates(const std::vector<Eigen::Vector3d>& points,
                                           int num_threads = 0);

}  // namespace facula
