// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/apps/map_mpi/rank_figures.hpp>
#include <facula/apps/map_mpi/ranks.hpp>
#include <facula/map/occupancy_map.hpp>

#include <filesystem>
#include <vector>

namespace facula {

/// What to map and where to put it.
struct MapProject {
  std::vector<std::filesystem::path> scans;  ///< files and projects, on a disk all ranks see
  std::filesystem::path out;                 ///< folder that appears whole or not at all
  bool overwrite = false;                    ///< whether a map may lie there already
  OccupancyOptions options;                  ///< the same on all ranks but for threads
};

/// Makes the map on all ranks and writes it as map_folder.hpp says. Returns what every rank has
/// done on the first rank, nothing on the others. Throws StepFailed on all ranks where it fails on
/// any.
std::vector<RankFigures> map_project(const MapProject& project, const Ranks& ranks);

}  // namespace facula
