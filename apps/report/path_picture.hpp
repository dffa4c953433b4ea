// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/apps/report/drawing.hpp>
#include <facula/map/occupancy_map.hpp>
#include <facula/map/path_plan.hpp>

namespace facula {

/// A path over the map seen from above, coloured by its clearance. The map is cut to the heights
/// that a ball of this radius [m] comes to on its way. Throws Error when the plan has no samples,
/// or nothing is known at these heights.
Image8 path_picture(const OccupancyMap& map, const PathPlan& plan, double radius);

}  // namespace facula
