// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/map/occupancy_map.hpp>

#include <cstddef>
#include <functional>
#include <optional>

#include <Eigen/Core>

namespace facula {

/// A rectangle of columns of cells, seen from above. Row 0 is the top of the picture, the largest
/// y.
struct PlanFrame {
  int rows = 0;           ///< [1]
  int cols = 0;           ///< [1]
  int first_x = 0;        ///< key of the left column
  int first_y = 0;        ///< key of the lowest row
  double resolution = 0;  ///< edge of a cell [m]

  std::size_t size() const {
    return static_cast<std::size_t>(rows) * static_cast<std::size_t>(cols);
  }

  /// Place of a column in an array that goes row by row from the top.
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(rows - 1 - (y - first_y)) * static_cast<std::size_t>(cols) +
           static_cast<std::size_t>(x - first_x);
  }

  /// Lower left corner, world x and y [m].
  Eigen::Vector2d origin() const {
    return {(first_x - kCentreKey) * resolution, (first_y - kCentreKey) * resolution};
  }
};

/// The cells of a brick that a picture from above takes in.
using BrickChoice = std::function<CellMask(const OccupancyMap::BrickView&)>;

/// The smallest frame around the columns that hold a chosen cell; none where no cell is chosen.
/// Throws Error for more than 2^28 columns, as one stray point far out can ask for.
std::optional<PlanFrame> plan_frame(const OccupancyMap& map, const BrickChoice& chosen);

}  // namespace facula
