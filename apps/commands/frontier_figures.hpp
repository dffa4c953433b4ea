// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/image_view.hpp>
#include <facula/apps/cli/figures.hpp>
#include <facula/map/frontiers.hpp>
#include <facula/map/height_map.hpp>

namespace facula {

/// Height and extent of a floor, given or found.
void report_floor(const Floor& floor, Figures& figures);

/// Size and heights of a height map.
void report_height_map(const HeightMap& heights, double max_height, Figures& figures);

/// Frontiers and suggestions, these as a table.
void report_frontiers(const Frontiers& frontiers, Figures& figures);

/// The map between floor and scanner from above, with the suggestions as numbered marks whose
/// strokes point to what there is to see.
Image8 frontier_picture(const OccupancyMap& map, const Floor& floor, const Frontiers& frontiers);

}  // namespace facula
