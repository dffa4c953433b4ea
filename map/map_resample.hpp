// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/rigid_transform.hpp>
#include <facula/map/occupancy_map.hpp>

#include <cstdint>
#include <functional>

namespace facula {

/// The grid that a map is to be seen in.
struct ResampleGrid {
  double resolution = 0;              ///< edge of a cell [m], above 0
  RigidTransform target_from_source;  ///< from the map's frame to the grid's
  int num_threads = 0;                ///< 0 = all cores [1]
};

/// A brick of the grid with the log-odds of the map's cells that the middles of its cells fall
/// into.
struct ResampledBrick {
  std::uint64_t code = 0;
  CellMask known;
  LogOddsBrick::Values values{};  ///< of the known cells, else 0 [1]
};

/// Calls visit for every brick of the grid that the map knows something of, in ascending order of
/// codes, from one thread. Throws Error as merge_map() does.
void for_each_resampled(const OccupancyMap& source,
                        const ResampleGrid& grid,
                        const std::function<void(const ResampledBrick&)>& visit);

/// Whether middles of cells fall on middles of cells: cells as large, a shift by whole cells (to a
/// millionth of one), turned by right angles at most.
bool fits_cells(const OccupancyMap& source, const ResampleGrid& grid);

}  // namespace facula
