// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <Eigen/Core>

namespace facula {

/// The width by CGAL: convex_hull_3 with exact decisions, then Width_3 in whole numbers over the
/// hull's corners. Coordinates are multiples of `unit`, a power of two.
double cgal_hull_and_width(const std::vector<Eigen::Vector3d>& points, double unit);

}  // namespace facula
