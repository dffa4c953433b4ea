// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/apps/cli/figures.hpp>
#include <facula/map/map_file.hpp>
#include <facula/map/navigation_grid.hpp>
#include <facula/map/occupancy_map.hpp>

namespace facula {

/// Cells, nodes and extent of a map.
void report_map(const OccupancyMap& map, Figures& figures);

/// The same, the sensor model and the scans that a map file keeps.
void report_map_file(const MapFile& file, Figures& figures);

/// Size, resolution and cells of a grid.
void report_grid(const NavigationGrid& grid, Figures& figures);

}  // namespace facula
