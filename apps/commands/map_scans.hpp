// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/apps/cli/session.hpp>
#include <facula/apps/commands/posed_scans.hpp>
#include <facula/map/occupancy_map.hpp>
#include <facula/map/scan_map.hpp>

#include <filesystem>
#include <string>

namespace facula {

/// Casts scans into a map, one after the other. Throws Error when no point lies within its cells.
OccupancyMap map_of_scans(const PosedScans& scans,
                          const OccupancyOptions& options,
                          Session& session);

/// Lets liboctomap make the map of the same scans once more. Throws Error when a byte differs.
void verify_map(const OccupancyMap& map, const PosedScans& scans, Session& session);

/// Brings a map that keeps its scans up to date: a scan of a new name is added, one whose cells are
/// no longer the same (it stands elsewhere, or was made anew) replaces the one of its name, and
/// only the bricks that either met are made again.
void update_map(ScanMap& map, const PosedScans& scans, Session& session);

/// A .fmap file with its scans. Throws Error when it keeps none and is not empty.
ScanMap read_scan_map(const std::filesystem::path& file, int num_threads);

/// Takes a scan out of a map by its name.
void remove_scan(ScanMap& map, const std::string& name, Session& session);

}  // namespace facula
