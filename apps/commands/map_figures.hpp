// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/apps/cli/figures.hpp>
#include <facula/map/navigation_grid.hpp>
#include <facula/map/occupancy_map.hpp>

namespace facula {

/// Cells, nodes and extent of a map.
void report_map(const OccupancyMap& map, Figures& figures);

/// Size, resolution and cells of a grid.
void report_grid(const NavigationGrid& grid, Figures& figures);

}  // namespace facula
