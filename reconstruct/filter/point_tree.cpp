// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/parallel.hpp>
#include <facula/reconstruct/filter/point_tree.hpp>

#include <algorithm>

namespace facula {
namespace {

/// A part of the tree that is not built yet: its node and its leaves.
struct Part {
  std::size_t node;
  std::size_t first_leaf;
  std::size_t leaves;
};

class TreeBuilder {
 public:
  TreeBuilder(std::vector<TreeItem>& items, PointTree& tree) : items_(items), tree_(tree) {}

  /// Finishes the node of a part. Returns whether it has children, which `left` and `right` are.
  bool split(const Part& part, Part& left, Part& right) {
    const auto begin = items_.begin() + std::ptrdiff_t(part.first_leaf * TreeLeaf::kSize);
    const std::size_t after = (part.first_leaf + part.leaves) * TreeLeaf::kSize;
    const auto end = items_.begin() + std::ptrdiff_t(std::min(items_.size(), after));
    TreeNode& node = tree_.nodes[part.node];
    put_box(node, begin, end);
    if (part.leaves == 1) {
      fill_leaf(part.first_leaf, begin, end);
      node.leaf = static_cast<std::uint32_t>(part.first_leaf);
      return false;
    }
    const std::size_t half = part.leaves / 2;
    const int axis = widest_side(node);
    // The index settles ties, so that both sides are the same wherever this runs.
    std::nth_element(begin,
                     begin + std::ptrdiff_t(half * TreeLeaf::kSize),
                     end,
                     [axis](const TreeItem& a, const TreeItem& b) {
                       return a.at[axis] != b.at[axis] ? a.at[axis] < b.at[axis]
                                                       : a.index < b.index;
                     });
    left = {part.node + 1, part.first_leaf, half};
    right = {part.node + 2 * half, part.first_leaf + half, part.leaves - half};
    node.right = static_cast<std::uint32_t>(right.node);
    return true;
  }

  void finish(const Part& part) {
    Part left{};
    Part right{};
    if (!split(part, left, right)) return;
    finish(left);
    finish(right);
  }

 private:
  using Items = std::vector<TreeItem>::iterator;

  static void put_box(TreeNode& node, Items begin, Items end) {
    for (int axis = 0; axis < 3; ++axis) node.low[axis] = node.high[axis] = begin->at[axis];
    for (Items item = begin; item != end; ++item) {
      for (int axis = 0; axis < 3; ++axis) {
        node.low[axis] = std::min(node.low[axis], item->at[axis]);
        node.high[axis] = std::max(node.high[axis], item->at[axis]);
      }
    }
  }

  static int widest_side(const TreeNode& node) {
    int widest = 0;
    for (int axis = 1; axis < 3; ++axis) {
      if (node.high[axis] - node.low[axis] > node.high[widest] - node.low[widest]) widest = axis;
    }
    return widest;
  }

  void fill_leaf(std::size_t leaf, Items begin, Items end) {
    TreeLeaf& filled = tree_.leaves[leaf];
    for (std::size_t i = 0; begin + std::ptrdiff_t(i) != end; ++i) {
      const TreeItem& item = begin[std::ptrdiff_t(i)];
      filled.x[i] = item.at[0];
      filled.y[i] = item.at[1];
      filled.z[i] = item.at[2];
      filled.index[i] = item.index;
    }
  }

  std::vector<TreeItem>& items_;
  PointTree& tree_;
};

}  // namespace

PointTree build_point_tree(std::vector<TreeItem> items, int num_threads) {
  PointTree tree;
  tree.points = items.size();
  if (items.empty()) return tree;
  const std::size_t leaves = (items.size() + TreeLeaf::kSize - 1) / TreeLeaf::kSize;
  tree.leaves.resize(leaves);
  tree.nodes.resize(2 * leaves - 1);
  TreeBuilder builder(items, tree);
  std::vector<Part> parts{{0, 0, leaves}};
  const auto each_part = [&](const auto& body) {
    parallel_for(parts.size(),
                 [&](std::size_t i, std::size_t) { body(i); },
                 {.num_threads = num_threads, .chunk = 1});
  };
  // The upper levels one by one, their parts at once; then the rest of the tree, subtree by
  // subtree.
  constexpr int kUpperLevels = 4;
  for (int level = 0; level < kUpperLevels && leaves > 1024; ++level) {
    std::vector<Part> halves(2 * parts.size());
    each_part([&](std::size_t i) { builder.split(parts[i], halves[2 * i], halves[2 * i + 1]); });
    parts = std::move(halves);
  }
  each_part([&](std::size_t i) { builder.finish(parts[i]); });
  return tree;
}

}  // namespace facula
