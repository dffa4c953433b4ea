// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/simulate/scene.hpp>
#include <facula/apps/cli/figures.hpp>
#include <facula/map/occupancy_map.hpp>

namespace facula {

/// Shares of cells (of the finest size) that contradict the scene. An occupied cell is wrong when
/// its centre lies farther from every surface than half the cell's diagonal plus `tolerance` [m]
/// (then no surface passes the cell, however the points scatter within it). A free cell is wrong
/// when its centre lies inside matter, deeper than one edge of a cell.
void report_map_errors(const OccupancyMap& map,
                       const Scene& scene,
                       double tolerance,
                       int num_threads,
                       Figures& figures);

}  // namespace facula
