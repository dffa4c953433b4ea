// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/map/pruned_octree.hpp>

#include <algorithm>
#include <span>

namespace facula {
namespace {

constexpr std::size_t kUpperLevels = kTreeDepth - kBrickLevel;

/// Place of a cell within its brick, from its place in Morton order.
std::array<std::uint16_t, kCellsPerBrick> make_morton_order() {
  std::array<std::uint16_t, kCellsPerBrick> order{};
  for (std::size_t m = 0; m < kCellsPerBrick; ++m) {
    order[m] = static_cast<std::uint16_t>(gather_bits(m) | gather_bits(m >> 1) << 3 |
                                          gather_bits(m >> 2) << 6);
  }
  return order;
}

struct Node {
  float value = 0;
  bool leaf = false;
  std::uint8_t children = 0;
  bool exists = false;
};

Node cell_node(float value) {
  return {value, true, 0, true};
}

/// OctoMap's rule: eight equal leaves become one; an inner node has the value of its likeliest
/// child.
Node parent_of(std::span<const Node, 8> children) {
  Node parent;
  bool prunable = true;
  for (std::size_t i = 0; i < 8; ++i) {
    const Node& child = children[i];
    prunable = prunable && child.exists && child.leaf && child.value == children[0].value;
    if (!child.exists) continue;
    if (!parent.exists || child.value > parent.value) parent.value = child.value;
    parent.exists = true;
    parent.children |= static_cast<std::uint8_t>(1U << i);
  }
  if (!prunable) return parent;
  return cell_node(children[0].value);
}

}  // namespace

struct PrunedOctree::BrickNodes {
  std::array<Node, 512> cells;
  std::array<Node, 64> pairs;  // two cells along an edge
  std::array<Node, 8> fours;
  Node brick;
};

PrunedOctree::BrickNodes PrunedOctree::nodes_of(const LogOddsBrick& brick) const {
  static const auto order = make_morton_order();
  BrickNodes nodes;
  LogOddsBrick::Values values;
  const CellMask known = brick.read(values);
  for (std::size_t m = 0; m < kCellsPerBrick; ++m) {
    const std::size_t cell = order[m];
    if (!known.test(cell)) continue;
    nodes.cells[m] = cell_node(reading_ ? reading_(values[cell]) : values[cell]);
  }
  const auto raise = [](const auto& lower, auto& upper) {
    for (std::size_t i = 0; i < upper.size(); ++i) {
      upper[i] = parent_of(std::span<const Node, 8>(&lower[8 * i], 8));
    }
  };
  raise(nodes.cells, nodes.pairs);
  raise(nodes.pairs, nodes.fours);
  nodes.brick = parent_of(nodes.fours);
  return nodes;
}

PrunedOctree::PrunedOctree(const LogOddsMap& map, const Reading& reading)
    : bricks_(map.sorted()), reading_(reading) {
  std::vector<Summary>& lowest = levels_.emplace_back();
  lowest.reserve(bricks_.size());
  for (const LogOddsMap::Entry* entry : bricks_) {
    if (const auto value = entry->brick.uniform()) {
      lowest.push_back({entry->code, reading_ ? reading_(*value) : *value, true, 0});
      continue;
    }
    const BrickNodes nodes = nodes_of(entry->brick);
    lowest.push_back({entry->code, nodes.brick.value, nodes.brick.leaf, nodes.brick.children});
    if (nodes.brick.leaf) continue;
    for (const Node& four : nodes.fours) {
      if (four.exists && !four.leaf)
        size_ += static_cast<std::size_t>(std::popcount(four.children));
    }
    for (std::size_t i = 0; i < nodes.pairs.size(); ++i) {
      const Node& pair = nodes.pairs[i];
      if (!nodes.fours[i / 8].leaf && pair.exists && !pair.leaf) {
        size_ += static_cast<std::size_t>(std::popcount(pair.children));
      }
    }
  }
  for (std::size_t level = 0; level < kUpperLevels; ++level) add_level();
  for (const auto& level : levels_) {
    for (const Summary& node : level)
      size_ += static_cast<std::size_t>(std::popcount(node.children));
  }
  if (!levels_.back().empty()) ++size_;
}

void PrunedOctree::add_level() {
  const std::vector<Summary>& lower = levels_.back();
  std::vector<Summary> upper;
  for (std::size_t i = 0; i < lower.size();) {
    const std::uint64_t code = lower[i].code >> 3;
    std::array<Node, 8> children;
    for (; i < lower.size() && lower[i].code >> 3 == code; ++i) {
      children[lower[i].code & 7] = {lower[i].value, lower[i].leaf, lower[i].children, true};
    }
    const Node parent = parent_of(children);
    upper.push_back({code, parent.value, parent.leaf, parent.children});
  }
  levels_.push_back(std::move(upper));
}

void PrunedOctree::visit_brick(std::size_t brick,
                               const std::function<void(const OctreeNode&)>& visit) const {
  const CellKey corner = first_cell(bricks_[brick]->code);
  const Summary& summary = levels_.front()[brick];
  if (summary.leaf) return visit({kBrickLevel, corner, summary.value, 0});
  const BrickNodes nodes = nodes_of(bricks_[brick]->brick);
  const auto show = [&](int level, std::size_t place, const Node& node) {
    const std::uint64_t m = place << (3 * level);
    const auto part = [&](int axis) {
      return corner[static_cast<std::size_t>(axis)] + static_cast<int>(gather_bits(m >> axis));
    };
    visit({level, {part(0), part(1), part(2)}, node.value, node.children});
    return !node.leaf;
  };
  show(kBrickLevel, 0, nodes.brick);
  for (std::size_t i = 0; i < 8; ++i) {
    if (!nodes.fours[i].exists || !show(2, i, nodes.fours[i])) continue;
    for (std::size_t j = 8 * i; j < 8 * i + 8; ++j) {
      if (!nodes.pairs[j].exists || !show(1, j, nodes.pairs[j])) continue;
      for (std::size_t k = 8 * j; k < 8 * j + 8; ++k) {
        if (nodes.cells[k].exists) show(0, k, nodes.cells[k]);
      }
    }
  }
}

void PrunedOctree::for_each_node(const std::function<void(const OctreeNode&)>& visit) const {
  // Every level holds its nodes in the order in which they are met: one place per level to go on
  // at.
  std::array<std::size_t, kUpperLevels + 1> next{};
  const auto descend = [&](const auto& self, std::size_t level, bool shown) -> void {
    const std::size_t place = next[level]++;
    const Summary& node = levels_[level][place];
    if (level == 0) {
      if (shown) visit_brick(place, visit);
      return;
    }
    if (shown) {
      const int height = static_cast<int>(level) + kBrickLevel;
      const auto part = [&](int axis) {
        return static_cast<int>(gather_bits(node.code >> axis) << height);
      };
      visit({height, {part(0), part(1), part(2)}, node.value, node.children});
    }
    const std::vector<Summary>& lower = levels_[level - 1];
    while (next[level - 1] < lower.size() && lower[next[level - 1]].code >> 3 == node.code) {
      self(self, level - 1, shown && !node.leaf);
    }
  };
  if (!levels_.back().empty()) descend(descend, kUpperLevels, true);
}

}  // namespace facula
