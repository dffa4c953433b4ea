// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/map/log_odds_map.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace facula {

/// A node of OctoMap's tree over the bricks.
struct OctreeNode {
  int level = 0;              ///< 0 is a cell, 16 the whole space [1]
  CellKey first{};            ///< its lowest cell
  float value = 0;            ///< log-odds; of an inner node the largest of its children's [1]
  std::uint8_t children = 0;  ///< bit x + 2 y + 4 z; 0 for a leaf
};

/// The tree that OctoMap would have: eight equal leaves are one leaf a level higher.
class PrunedOctree {
 public:
  /// What stands in the tree for a cell's log-odds; the cell's own by default.
  using Reading = std::function<float(float)>;

  explicit PrunedOctree(const LogOddsMap& map, const Reading& reading = {});

  /// Every node, parents before children, children in ascending order: the order of the files.
  void for_each_node(const std::function<void(const OctreeNode&)>& visit) const;

  std::size_t size() const { return size_; }  ///< nodes [1]

 private:
  struct Summary {
    std::uint64_t code;  ///< Morton code among the nodes of its level
    float value;
    bool leaf;
    std::uint8_t children;
  };
  /// The 512 cells of a brick and the nodes over them; level 3 is the brick.
  struct BrickNodes;

  BrickNodes nodes_of(const LogOddsBrick& brick) const;
  void add_level();
  void visit_brick(std::size_t brick, const std::function<void(const OctreeNode&)>& visit) const;

  std::vector<const LogOddsMap::Entry*> bricks_;
  Reading reading_;
  std::vector<std::vector<Summary>> levels_;  ///< from the bricks (0) up to the root (13)
  std::size_t size_ = 0;
};

}  // namespace facula
