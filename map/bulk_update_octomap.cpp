// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/map/bulk_update.hpp>

#include <bit>
#include <span>

#include <octomap/OcTree.h>

namespace facula {
namespace {

constexpr int kDepth = 16;
constexpr int kBrickLevel = 3;  // levels are counted from the cells up

using Bricks = std::span<const VoxelBrick>;

/// Cells of one word of a brick (a node two levels above the cells).
struct Word {
  std::uint64_t passed = 0;
  std::uint64_t ended = 0;

  bool any() const { return (passed | ended) != 0; }
};

class BulkUpdate {
 public:
  explicit BulkUpdate(octomap::OcTree& tree) : tree_(tree) {}

  /// Updates the cells of `bricks` below `node`; true when a cell was touched.
  bool update(octomap::OcTreeNode& node, bool created, int level, Bricks bricks) {
    const bool leaf = !created && !tree_.nodeHasChildren(&node);
    if (leaf && is_settled(node, created, all_cells(bricks))) return false;
    if (level == kBrickLevel) return update_brick(node, created, bricks.front());
    bool touched = false;
    const int shift = 3 * (level - 1 - kBrickLevel);
    while (!bricks.empty()) {
      const std::uint64_t branch = bricks.front().code >> shift;
      std::size_t count = 1;
      while (count < bricks.size() && bricks[count].code >> shift == branch) ++count;
      const Child child = child_of(node, created, static_cast<unsigned>(branch & 7));
      touched |= update(*child.node, child.created, level - 1, bricks.first(count));
      bricks = bricks.subspan(count);
    }
    if (touched) summarise(node);
    return touched;
  }

 private:
  struct Child {
    octomap::OcTreeNode* node;
    bool created;
  };

  bool update_brick(octomap::OcTreeNode& node, bool created, const VoxelBrick& brick) {
    bool touched = false;
    for (unsigned i = 0; i < 8; ++i) {
      const Word word{brick.passed[i], brick.ended[i]};
      if (!word.any()) continue;
      const Child child = child_of(node, created, i);
      touched |= update_word(*child.node, child.created, 2, word);
    }
    if (touched) summarise(node);
    return touched;
  }

  bool update_word(octomap::OcTreeNode& node, bool created, int level, Word word) {
    if (is_settled(node, created, word)) return false;
    if (level == 0) {
      tree_.updateNodeLogOdds(&node, change_of(word));
      return true;
    }
    bool touched = false;
    const unsigned width = 1U << (3 * (level - 1));  // cells per child
    const std::uint64_t mask = (std::uint64_t{1} << width) - 1;
    for (unsigned i = 0; i < 8; ++i) {
      const Word part{(word.passed >> (i * width)) & mask, (word.ended >> (i * width)) & mask};
      if (!part.any()) continue;
      const Child child = child_of(node, created, i);
      touched |= update_word(*child.node, child.created, level - 1, part);
    }
    if (touched) summarise(node);
    return touched;
  }

  /// A leaf that is already as sure as it may get stays as it is, and is not expanded.
  bool is_settled(const octomap::OcTreeNode& node, bool created, Word cells) const {
    if (created || tree_.nodeHasChildren(&node)) return false;
    const float value = node.getLogOdds();
    if (cells.passed == 0) return value >= tree_.getClampingThresMaxLog();
    if (cells.ended == 0) return value <= tree_.getClampingThresMinLog();
    return false;
  }

  static Word all_cells(Bricks bricks) {
    Word all;
    for (const VoxelBrick& brick : bricks) {
      for (const std::uint64_t bits : brick.passed) all.passed |= bits;
      for (const std::uint64_t bits : brick.ended) all.ended |= bits;
    }
    return all;
  }

  /// A leaf above the cells stands for eight equal children, unless it was only just made.
  Child child_of(octomap::OcTreeNode& node, bool created, unsigned i) {
    if (!created && !tree_.nodeHasChildren(&node)) tree_.expandNode(&node);
    if (tree_.nodeChildExists(&node, i)) return {tree_.getNodeChild(&node, i), false};
    return {tree_.createNodeChild(&node, i), true};
  }

  void summarise(octomap::OcTreeNode& node) {
    if (!tree_.pruneNode(&node)) node.updateOccupancyChildren();
  }

  float change_of(Word cell) const {
    return cell.ended != 0 ? tree_.getProbHitLog() : tree_.getProbMissLog();
  }

  octomap::OcTree& tree_;
};

/// Takes bit i of every third place: the key of one axis within a Morton code.
std::uint64_t gather(std::uint64_t code) {
  std::uint64_t value = 0;
  for (unsigned i = 0; i < kDepth; ++i) value |= ((code >> (3 * i)) & 1) << i;
  return value;
}

/// Only the tree itself can make its root: the first cell goes in by the front door.
void make_root(octomap::OcTree& tree, VoxelBrick& brick) {
  for (std::size_t i = 0; i < 8; ++i) {
    const std::uint64_t any = brick.passed[i] | brick.ended[i];
    if (any == 0) continue;
    const std::uint64_t bit = any & (~any + 1);
    const auto place = static_cast<std::uint64_t>(64 * i) + std::countr_zero(bit);
    const std::uint64_t code = (brick.code << 9) | place;
    const auto axis = [&](unsigned a) { return static_cast<octomap::key_type>(gather(code >> a)); };
    tree.updateNode(octomap::OcTreeKey(axis(0), axis(1), axis(2)), (brick.ended[i] & bit) != 0);
    brick.passed[i] &= ~bit;
    brick.ended[i] &= ~bit;
    return;
  }
}

}  // namespace

void update_cells(octomap::OcTree& tree, std::vector<VoxelBrick> bricks) {
  if (bricks.empty()) return;
  if (tree.getRoot() == nullptr) make_root(tree, bricks.front());
  if (tree.getRoot() == nullptr) return;
  BulkUpdate(tree).update(*tree.getRoot(), false, kDepth, bricks);
}

}  // namespace facula
