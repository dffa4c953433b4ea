// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/apps/cli/arguments.hpp>
#include <facula/map/occupancy_map.hpp>

namespace facula {

/// Declares the options of whatever makes occupancy maps: cells, rays and the sensor's model.
void declare_occupancy(Arguments& arguments, OccupancyOptions& options);

}  // namespace facula
