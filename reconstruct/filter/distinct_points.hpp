// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

namespace facula {

/// The indices of the finite points in ascending order, the first one alone where several stand in
/// exactly one place: neighbours that are no farther away say nothing of a surface.
std::vector<std::size_t> distinct_points(const std::vector<Eigen::Vector3f>& points);

}  // namespace facula
