// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <Eigen/Core>

namespace facula {

struct RectangleSides {
  double longer = 0;   ///< [m]
  double shorter = 0;  ///< [m]
};

/// Corners of the convex hull, anticlockwise, without corners on its sides. A line gives its two
/// ends, one place one corner, no points none.
std::vector<Eigen::Vector2d> convex_hull(std::vector<Eigen::Vector2d> points);

/// Area of a polygon, above 0 when its corners run anticlockwise [m^2].
double polygon_area(const std::vector<Eigen::Vector2d>& corners);

/// Distance of the two nearest parallel lines that hold a convex polygon between them [m].
double smallest_width(const std::vector<Eigen::Vector2d>& hull);

/// Sides of the rectangle of least area around the points, in any direction. Zeros for no points.
RectangleSides smallest_bounding_rectangle(std::vector<Eigen::Vector2d> points);

}  // namespace facula
