// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/map/occupancy_map.hpp>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace facula {

struct NavigationGridOptions {
  double min_height = 0.1;  ///< lowest part of space that blocks the robot, world z [m]
  double max_height = 1.5;  ///< highest part [m]
  double inflation = 0;     ///< cells this near an occupied one become occupied too [m], 0 or more

  /// Throws Error unless max_height is above min_height.
  void check() const;
};

/// A map seen from above. Row 0 is the top of the picture, the largest y.
struct NavigationGrid {
  int rows = 0;                                      ///< [1]
  int cols = 0;                                      ///< [1]
  double resolution = 0;                             ///< edge of a cell [m]
  Eigen::Vector2d origin = Eigen::Vector2d::Zero();  ///< lower left corner, world x and y [m]
  std::vector<std::uint8_t> cells;                   ///< row by row from the top: one of the three
  std::vector<std::int8_t> occupancy = {};           ///< probability [%], 0 to 100; -1 unknown

  static constexpr std::uint8_t kFree = 254;
  static constexpr std::uint8_t kOccupied = 0;
  static constexpr std::uint8_t kUnknown = 205;

  std::size_t size() const {
    return static_cast<std::size_t>(rows) * static_cast<std::size_t>(cols);
  }
};

/// A column of cells is occupied where any cell between the heights is, free where one is free and
/// none occupied, else unknown; its probability is the largest of its cells. The grid covers the
/// cells known between the heights. Throws Error when there are none.
NavigationGrid navigation_grid(const OccupancyMap& map, const NavigationGridOptions& options = {});

/// Makes every cell, unknown ones too, occupied (100 %) whose centre is at most `radius` [m] from
/// the centre of an occupied one: where the centre of a round robot must not be.
void inflate(NavigationGrid& grid, double radius);

/// How a map server takes grey values.
enum class GridMode {
  kTrinary,  ///< free, occupied, unknown, in a .pgm
  kScale,    ///< lightness is the probability of being free, unknown is transparent: a .png
  kRaw       ///< the grey value is the occupancy [%], 255 is unknown, in a .pgm
};

/// Throws Error for words other than trinary, scale and raw.
GridMode grid_mode(const std::string& word);
std::string to_string(GridMode mode);

struct GridFileOptions {
  GridMode mode = GridMode::kTrinary;
  bool ros1 = false;    ///< scale: free below 0.196 as in ROS 1, else below nav2's 0.25
  bool negate = false;  ///< light is occupied; not in raw, where the servers differ

  /// Probabilities above are occupied and below are free [1]. In trinary free_thresh is 0.196 for
  /// nav2 too: unknown is the grey value 205, and (255 - 205) / 255 = 0.19608 would be free below
  /// nav2's default of 0.25.
  double occupied_thresh() const { return 0.65; }
  double free_thresh() const { return ros1 || mode != GridMode::kScale ? 0.196 : 0.25; }
  void check() const;
};

/// Writes STEM.yaml and, beside it, STEM.pgm (scale: STEM.png), with a full-precision origin.
/// Throws Error when a file cannot be written; modes scale and raw need `occupancy`.
void write_navigation_grid(const std::filesystem::path& yaml_path,
                           const NavigationGrid& grid,
                           const GridFileOptions& options = {});

/// Reads such a pair, also one of the ROS map savers; pictures are .pgm or what OpenCV reads.
/// `occupancy` is what nav2's map server would publish (in mode scale the probabilities between the
/// thresholds are stretched to 0 to 100), `cells` are occupied from 50 %. Throws Error when either
/// file is missing or torn.
NavigationGrid read_navigation_grid(const std::filesystem::path& yaml_path);

}  // namespace facula
