// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/point_cloud.hpp>
#include <facula/map/cell_colors.hpp>

#include <cstdint>
#include <vector>

namespace facula {

/// The colour that OctoMap knows no colour by.
constexpr Color kNoColor = {255, 255, 255};

/// Place of a cell among all in Morton order; shifted by 3 bits per level that of a node over it.
std::uint64_t cell_code(const CellKey& cell);

/// Colours of the nodes of an octree over coloured cells, as ColorOcTree has them: an inner node
/// has the mean of those of its children that have one, each channel rounded down.
class ColorTree {
 public:
  explicit ColorTree(const CellColors& colors);

  struct Node {
    std::uint64_t code = 0;  ///< cell_code() of a cell in it, shifted by its level
    Color color = kNoColor;
    bool uniform = false;  ///< all its cells have this colour
  };

  /// Null where no cell of the node has a colour. `level` 0 is a cell, 16 the whole space.
  const Node* find(int level, std::uint64_t code) const;

 private:
  std::vector<std::vector<Node>> levels_;
};

}  // namespace facula
