// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/map/cell_colors.hpp>
#include <facula/map/log_odds_map.hpp>

#include <cstddef>
#include <filesystem>
#include <iosfwd>
#include <string>
#include <string_view>

namespace facula {

/// Most bricks that the large leaves of a file may ask for: 700 MB. A hundred bytes can declare all
/// of space to be free.
constexpr std::size_t kMaxLeafBricks = std::size_t{1} << 24;

/// A map and its resolution, as OctoMap's files hold them.
struct OctreeContent {
  double resolution = 0;  ///< edge of a cell [m]
  LogOddsMap map;
  CellColors colors;  ///< one point each; empty where the file has none
};

/// Reads OctoMap's .ot or .bt from memory; in a .bt occupied cells get the model's largest
/// log-odds, free ones the least. Of a ColorOcTree the colours are read too, but for white, which
/// stands for none. `name` is the file's name for messages. Throws Error where a file
/// is torn or damaged, or its leaves cover more space than bricks can be made for.
OctreeContent parse_octree(std::string_view file,
                           const LogOddsModel& model,
                           const std::string& name,
                           std::size_t max_leaf_bricks = kMaxLeafBricks);

/// The same from a file.
OctreeContent read_octree(const std::filesystem::path& path, const LogOddsModel& model);

/// Writes .ot: every log-odds value; the bytes of liboctomap's OcTree::write().
void write_ot(std::ostream& stream, const LogOddsMap& map, double resolution);

/// Writes .ot with colours: a ColorOcTree. Equal leaves become one only where their colours are
/// equal too, so that no colour is lost; OctoMap would mix them. Cells without a colour, and white
/// ones, get OctoMap's white for none. Reading gives back the mean colours, one point each.
void write_color_ot(std::ostream& stream,
                    const LogOddsMap& map,
                    const CellColors& colors,
                    double resolution);

/// Writes .bt: free or occupied, whichever is likelier; the bytes of OcTree::writeBinary().
void write_bt(std::ostream& stream, const LogOddsMap& map, double resolution);

}  // namespace facula
