// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/rig/rig.hpp>
#include <facula/apps/cli/arguments.hpp>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace facula {

/// The line on a flat wall square to the camera's axis.
struct Wall {
  double distance = 0;            ///< [m]
  std::vector<double> positions;  ///< per line of the picture, NaN where not seen [px]
};

/// How frames of walls are searched, as options.
struct WallStripe {
  std::string channel = "maximum";
  double sigma = 2;  ///< [px]
};
void declare_wall_stripe(Arguments& arguments, WallStripe& stripe);

/// Reads walls, nearest first, from a table of one of three kinds, told apart by its columns:
///   distance_mm, frame                        a picture per row, named from the table's folder
///   distance_mm, line, position_px            a line of the picture per row
///   true_m, top_px, centre_px, bottom_px      a parabola through the first, middle and last line
/// Rows of the same distance are averaged. Distances may stand in distance_mm, distance_m, true_mm
/// or true_m. Throws Error when the table is none of these or a frame does not fit the rig's
/// camera.
std::vector<Wall> read_walls(const std::filesystem::path& table,
                             const Rig& rig,
                             const WallStripe& stripe);

/// The line's position in the middle of the picture, mean of `lines` of them [px]; NaN when none
/// was seen.
double middle_position(const Wall& wall, int lines = 9);

/// Columns in which a table may hold distances and positions.
inline const std::vector<std::string> kDistanceColumns = {
    "distance_mm", "distance_m", "true_mm", "true_m"};
inline const std::vector<std::string> kPositionColumns = {"position_px", "pixel_px"};

}  // namespace facula
