// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/apps/cli/arguments.hpp>
#include <facula/apps/cli/session.hpp>
#include <facula/map/frontiers.hpp>
#include <facula/map/navigation_grid.hpp>
#include <facula/map/occupancy_map.hpp>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace facula {

/// What robots and people want of a map, beside the map itself.
struct MapOutputs {
  std::filesystem::path grid;
  std::string grid_mode = "trinary";
  bool ros1 = false;
  NavigationGridOptions band;
  bool above_floor = false;     ///< heights count from the floor
  std::optional<double> floor;  ///< its height, world z [m]; else it is found
  std::vector<std::filesystem::path> height_maps;
  std::vector<std::filesystem::path> frontiers;
  FrontierOptions next_scans;

  bool any() const { return !grid.empty() || !height_maps.empty() || !frontiers.empty(); }
};

void declare_map_outputs(Arguments& arguments, MapOutputs& outputs);

/// Before long work: throws Error for files that could not be written and options that cannot be.
void check_map_outputs(const MapOutputs& outputs);

/// Writes what was asked for and reports it in parts "floor", "grid", "height_map", "frontiers".
void write_map_outputs(const OccupancyMap& map, const MapOutputs& outputs, Session& session);

}  // namespace facula
