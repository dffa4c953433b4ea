// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/map/color_tree.hpp>

#include <algorithm>
#include <array>

namespace facula {
namespace {

using Nodes = std::vector<ColorTree::Node>;

Nodes cells_of(const CellColors& colors) {
  Nodes cells;
  for (const ColorBrick* brick : colors.sorted()) {
    const CellKey first = first_cell(brick->code);
    std::size_t rank = 0;
    for_each_cell(brick->cells, [&](std::size_t place) {
      const Color color = brick->sums[rank++].mean();
      if (color != kNoColor) cells.push_back({cell_code(cell_at(first, place)), color, true});
    });
  }
  std::sort(
      cells.begin(), cells.end(), [](const auto& a, const auto& b) { return a.code < b.code; });
  return cells;
}

/// The node over [begin, end), which are some of its children.
ColorTree::Node parent_of(Nodes::const_iterator begin, Nodes::const_iterator end) {
  ColorTree::Node parent{.code = begin->code >> 3, .color = kNoColor, .uniform = end - begin == 8};
  std::array<int, 3> sum = {};
  int count = 0;
  for (auto child = begin; child != end; ++child) {
    parent.uniform = parent.uniform && child->uniform && child->color == begin->color;
    if (child->color == kNoColor) continue;
    ++count;
    for (std::size_t i = 0; i < 3; ++i) sum[i] += child->color[i];
  }
  if (count == 0) return parent;
  for (std::size_t i = 0; i < 3; ++i) parent.color[i] = static_cast<std::uint8_t>(sum[i] / count);
  return parent;
}

Nodes parents_of(const Nodes& children) {
  Nodes parents;
  for (auto begin = children.begin(); begin != children.end();) {
    auto end = begin;
    while (end != children.end() && end->code >> 3 == begin->code >> 3) ++end;
    parents.push_back(parent_of(begin, end));
    begin = end;
  }
  return parents;
}

}  // namespace

std::uint64_t cell_code(const CellKey& cell) {
  const auto low = [&](std::size_t axis) {
    return spread_bits(static_cast<std::uint64_t>(cell[axis]) % kBrickEdge) << axis;
  };
  return brick_code(cell) << (3 * kBrickLevel) | low(0) | low(1) | low(2);
}

ColorTree::ColorTree(const CellColors& colors) {
  levels_.push_back(cells_of(colors));
  for (int level = 1; level <= kTreeDepth; ++level) levels_.push_back(parents_of(levels_.back()));
}

const ColorTree::Node* ColorTree::find(int level, std::uint64_t code) const {
  const Nodes& nodes = levels_[static_cast<std::size_t>(level)];
  const auto node = std::lower_bound(
      nodes.begin(), nodes.end(), code, [](const Node& a, std::uint64_t b) { return a.code < b; });
  return node == nodes.end() || node->code != code ? nullptr : &*node;
}

}  // namespace facula
