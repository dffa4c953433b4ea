// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/rigid_transform.hpp>
#include <facula/apps/report/drawing.hpp>
#include <facula/apps/report/grid_layout.hpp>
#include <facula/map/height_map.hpp>
#include <facula/map/navigation_grid.hpp>
#include <facula/map/occupancy_map.hpp>

#include <limits>
#include <string>
#include <vector>

namespace facula {

/// How map_top_view() lays out a navigation grid, inside the margins of a plot.
GridLayout map_layout(const NavigationGrid& grid);

/// A navigation grid from above, y (north) up: free light, occupied dark, unknown grey; scan poses
/// as numbered marks with a stroke along their x axis, which the legend calls `marks`; axes in
/// metres and a scale bar. Throws Error when the number of cells does not fit; an empty grid gives
/// a picture that says so.
Image8 map_top_view(const NavigationGrid& grid,
                    const std::vector<RigidTransform>& world_from_scan = {},
                    const std::string& marks = "scan, stroke along its x axis");

/// A height map from above, coloured by height. Throws Error when the number of cells does not fit.
Image8 map_top_view(const HeightMap& heights,
                    const std::vector<RigidTransform>& world_from_scan = {});

/// An occupancy map from above: the highest occupied cell of every column coloured by its height.
/// Cells whose centres lie above `cut_height` [m] are left out (a ceiling, say).
Image8 map_top_view(const OccupancyMap& map,
                    const std::vector<RigidTransform>& world_from_scan = {},
                    double cut_height = std::numeric_limits<double>::infinity());

}  // namespace facula
