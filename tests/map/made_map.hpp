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

/// A hall of 4 x 4 x 2 m of free cells of 10 cm, its corner at 0, and a wall across it at x = 2 to
/// 2.1 m with a door from y = 3 to 3.8 m as high as the hall.
inline OccupancyMap hall_with_door() {
  OccupancyMap map({.resolution = 0.1});
  for_each_cell_of({near_centre(0, 0, 0), near_centre(39, 39, 19)}, [&](const CellKey& cell) {
    const int y = cell[1] - kCentreKey;
    const bool wall = cell[0] == kCentreKey + 20 && (y < 30 || y > 37);
    set_cell(map, cell, wall ? kOccupiedValue : kFreeValue);
  });
  return map;
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
