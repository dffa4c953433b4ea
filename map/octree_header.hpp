// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/point_cloud.hpp>
#include <facula/map/cell_key.hpp>

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace facula {

/// The text in front of the nodes of an OctoMap file.
struct OctreeHeader {
  bool binary = false;         ///< .bt: two bits per child; else .ot: float and child mask per node
  bool colored = false;        ///< ColorOcTree: in .ot three bytes of colour behind the float
  std::size_t nodes = 0;       ///< as the header counts them [1]
  double resolution = 0;       ///< edge of a cell [m]
  std::size_t data_begin = 0;  ///< where the nodes start in the file [bytes]
};

/// Reads the header at the start of `file`. `name` is the file's name for messages. Throws Error
/// when it is not an OctoMap file, is one of the kinds this program does not read (stamped,
/// counting), or lacks an entry.
OctreeHeader parse_octree_header(std::string_view file, const std::string& name);

/// Walks over the nodes and throws Error unless they fill the file exactly, are as many as the
/// header says, at most 16 levels deep, and hold finite values.
void check_octree_nodes(const OctreeHeader& header, std::string_view file, const std::string& name);

/// A leaf of the tree in a file.
struct OctreeLeaf {
  int level = 0;    ///< 0 is a cell, 16 the whole space [1]
  CellKey first{};  ///< its lowest cell
  float value = 0;  ///< log-odds [1]
  std::optional<Color> color = std::nullopt;
};

/// Every leaf, in the file's order. `free_and_occupied` are the log-odds that a .bt's leaves stand
/// for. The file must have passed check_octree_nodes().
void for_each_octree_leaf(const OctreeHeader& header,
                          std::string_view file,
                          std::pair<float, float> free_and_occupied,
                          const std::function<void(const OctreeLeaf&)>& visit);

}  // namespace facula
