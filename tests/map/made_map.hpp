// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/random.hpp>
#include <facula/map/cell_box.hpp>

namespace facula {

// Maps made cell by cell, for tests.

inline constexpr float kFreeValue = -0.4F;      ///< log-odds [1]
inline constexpr float kOccupiedValue = 0.85F;  ///< log-odds [1]

inline void set_cell(OccupancyMap& map, const CellKey& cell, float value) {
  LogOddsBrick& brick = map.bricks().find_or_add(brick_code(cell));
  LogOddsBrick::Values values{};
  CellMask known = brick.read(values);
  values[cell_in_brick(cell)] = value;
  known.set(cell_in_brick(cell));
  brick.assign(values, known);
}

/// Calls visit(cell) for every cell of the box.
template <typename Visit>
void for_each_cell_of(const CellBox& box, const Visit& visit) {
  CellKey cell{};
  for (cell[2] = box.low[2]; cell[2] <= box.high[2]; ++cell[2]) {
    for (cell[1] = box.low[1]; cell[1] <= box.high[1]; ++cell[1]) {
      for (cell[0] = box.low[0]; cell[0] <= box.high[0]; ++cell[0]) visit(cell);
    }
  }
}

/// The cell so many cells away from the one that begins at 0 m.
inline CellKey near_centre(int x, int y, int z) {
  return {kCentreKey + x, kCentreKey + y, kCentreKey + z};
}

struct CellShares {
  double unknown = 0;   ///< of all cells [1]
  double occupied = 0;  ///< of the known ones [1]
};

/// Cells of 10 cm, each drawn by itself.
inline OccupancyMap random_map(Random& random, const CellBox& box, const CellShares& shares) {
  OccupancyMap map({.resolution = 0.1});
  for_each_cell_of(box, [&](const CellKey& cell) {
    if (random.uniform() < shares.unknown) return;
    set_cell(map, cell, random.uniform() < shares.occupied ? kOccupiedValue : kFreeValue);
  });
  return map;
}

}  // namespace facula
