// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <Eigen/Core>

namespace facula {

struct RectangleSides {
  double longer = 0;   ///< [m]
  double shorter = 0;  ///< [m]
};

/// Sides of the rectangle of least area around the points, in any direction. Zeros for no points.
RectangleSides smallest_bounding_rectangle(std::vector<Eigen::Vector2d> points);

}  // namespace facula
