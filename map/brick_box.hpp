// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/map/cell_box.hpp>

namespace facula {

// Boxes whose unit is a brick of 8 x 8 x 8 cells.

/// The brick that holds a cell, counted along each axis.
inline CellKey brick_of(const CellKey& cell) {
  return {cell[0] / kBrickEdge, cell[1] / kBrickEdge, cell[2] / kBrickEdge};
}

/// The lowest cell of a brick.
inline CellKey first_of(const CellKey& brick) {
  return {brick[0] * kBrickEdge, brick[1] * kBrickEdge, brick[2] * kBrickEdge};
}

/// The bricks that have cells in the box.
inline CellBox bricks_of(const CellBox& cells) {
  return {brick_of(cells.low), brick_of(cells.high)};
}

/// Calls visit(brick) for the bricks of the box until it returns true, which is then the result.
template <typename Visit>
bool any_brick(const CellBox& bricks, const Visit& visit) {
  CellKey brick{};
  for (brick[2] = bricks.low[2]; brick[2] <= bricks.high[2]; ++brick[2]) {
    for (brick[1] = bricks.low[1]; brick[1] <= bricks.high[1]; ++brick[1]) {
      for (brick[0] = bricks.low[0]; brick[0] <= bricks.high[0]; ++brick[0]) {
        if (visit(brick)) return true;
      }
    }
  }
  return false;
}

}  // namespace facula
