// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/map/find_floor.hpp>
#include <facula/map/frontier_regions.hpp>
#include <facula/map/occupancy_map.hpp>
#include <facula/map/standpoints.hpp>

#include <cstddef>
#include <filesystem>
#include <vector>

#include <Eigen/Core>

namespace facula {

struct FrontierOptions {
  StandpointOptions stand;
  double range = 10.0;            ///< how far the scanner sees [m], above 0
  double view_cell = 0.15;        ///< least edge of the cells that are counted [m], above 0
  double margin = 2.0;            ///< unknown space around the map that counts [m], 0 or more
  double region_length = 2.0;     ///< longer frontiers are cut into regions of at most this [m]
  double min_volume = 0.1;        ///< suggestions that would see less are left out [m^3]
  std::size_t count = 5;          ///< suggestions at most, 1 to 1000 [1]
  std::size_t most_rays = 65536;  ///< directions per standpoint at most, at least 100 [1]
  int num_threads = 0;            ///< 0 = all cores [1]

  /// Throws Error naming the field, its value and its bound.
  void check() const;
};

/// A place to scan from next.
struct ScanSuggestion {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< of the scanner, world [m]
  double volume = 0;         ///< unknown space seen from there and from no earlier suggestion [m^3]
  double volume_alone = 0;   ///< the same if it were the only suggestion [m^3]
  FrontierRegion region;     ///< the one that most of the volume is seen through
  double region_volume = 0;  ///< seen through it [m^3]
};

struct Frontiers {
  double cell = 0;                          ///< edge of the cells that were counted [m]
  std::size_t cells = 0;                    ///< frontier cells [1]
  std::size_t regions = 0;                  ///< that they lie in [1]
  std::size_t standpoints = 0;              ///< of the lattice that were tried [1]
  std::size_t rays = 0;                     ///< from each of them [1]
  std::vector<ScanSuggestion> suggestions;  ///< the best first
};

/// Where to scan next. From every standpoint rays go in all directions through free and unknown
/// cells to the first occupied one; the distinct unknown cells they meet are what a scan from there
/// would see. The best standpoint is taken, what it sees is crossed off, and so on (Nemhauser et
/// al. 1978: at least 63 % of the best choice of as many). The cost is bounded by standpoints times
/// rays times range / cell. The same for any number of threads. Throws Error when the map is empty
/// or no tripod could stand anywhere.
Frontiers find_frontiers(const OccupancyMap& map,
                         const Floor& floor,
                         const FrontierOptions& options = {});

/// Suggestions as CSV: rank, position, volumes, centre and size of the region. Throws Error when
/// the file cannot be written.
void write_frontiers_csv(const std::filesystem::path& path, const Frontiers& frontiers);

}  // namespace facula
