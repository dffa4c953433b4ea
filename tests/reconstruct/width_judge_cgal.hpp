// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <Eigen/Core>

namespace facula {

/// The width by CGAL's Width_3 in whole numbers of any length, on points whose coordinates are
/// multiples of `unit`, a power of two. They must not lie in one plane.
double judged_width(const std::vector<Eigen::Vector3d>& points, double unit);

}  // namespace facula
