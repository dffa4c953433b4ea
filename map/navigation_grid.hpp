// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/map/occupancy_map.hpp>

#include <cstdint>
#include <filesystem>
#include <vector>

#include <Eigen/Core>

namespace facula {

struct NavigationGridOptions {
  double min_height = 0.1;  ///< lowest part of space that blocks the robot, world z [m]
  double max_height = 1.5;  ///< highest part [m]

  /// Throws Error unless max_height is above min_height.
  void check() const;
};

/// A map seen from above, as ROS map servers read it: 254 free, 0 occupied, 205 unknown. Row 0 is
/// the top of the image, the largest y.
struct NavigationGrid {
  int rows = 0;                                      ///< [1]
  int cols = 0;                                      ///< [1]
  double resolution = 0;                             ///< edge of a cell [m]
  Eigen::Vector2d origin = Eigen::Vector2d::Zero();  ///< lower left corner, world x and y [m]
  std::vector<std::uint8_t> cells;                   ///< row by row from the top

  static constexpr std::uint8_t kFree = 254;
  static constexpr std::uint8_t kOccupied = 0;
  static constexpr std::uint8_t kUnknown = 205;
};

/// A column of cells is occupied where any cell between the heights is, free where one is free and
/// none occupied, else unknown. The grid covers the cells known between the heights. Throws Error
/// when there are none.
NavigationGrid navigation_grid(const OccupancyMap& map, const NavigationGridOptions& options = {});

/// Writes STEM.yaml and, beside it, STEM.pgm (free_thresh 0.196, occupied_thresh 0.65,
/// full-precision origin).
void write_navigation_grid(const std::filesystem::path& yaml_path, const NavigationGrid& grid);

/// Reads such a pair, also one of the ROS map savers (mode trinary). Throws Error when either file
/// is missing or torn.
NavigationGrid read_navigation_grid(const std::filesystem::path& yaml_path);

}  // namespace facula
