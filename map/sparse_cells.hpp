// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/map/brick_index.hpp>
#include <facula/map/scan_cells.hpp>

#include <cstdint>
#include <vector>

namespace facula {

/// Cells collected brick by brick, wherever they are.
class SparseCells {
 public:
  void pass(const CellKey& key) { brick_of(key).passed.set(cell_in_brick(key)); }
  void end(const CellKey& key) { brick_of(key).ended.set(cell_in_brick(key)); }

  void merge(const SparseCells& more) {
    for (const ScanBrick& theirs : more.bricks_) {
      ScanBrick& ours = brick(theirs.code);
      ours.passed |= theirs.passed;
      ours.ended |= theirs.ended;
    }
  }

  /// All bricks in ascending order; leaves this empty. A cell that a ray ended in did not let it
  /// pass.
  std::vector<ScanBrick> take_sorted();

 private:
  ScanBrick& brick_of(const CellKey& key) {
    const std::uint64_t code = brick_code(key);
    if (last_ < bricks_.size() && bricks_[last_].code == code) return bricks_[last_];
    return brick(code);
  }
  ScanBrick& brick(std::uint64_t code) {
    bool added = false;
    last_ = index_.find_or_add(code, bricks_.size(), &added);
    if (added) bricks_.emplace_back().code = code;
    return bricks_[last_];
  }

  std::vector<ScanBrick> bricks_;
  BrickIndex index_;
  std::size_t last_ = 0;
};

}  // namespace facula
