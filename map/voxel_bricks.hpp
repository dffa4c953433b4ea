// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace facula {

/// Address of a cell of an octree of depth 16: cells counted from the corner of space, per axis.
using CellKey = std::array<int, 3>;

/// 8 x 8 x 8 cells with one bit each for "a ray passed" and "a ray ended". Bits stand in Morton
/// order (three bits x, y, z per level), so the eight cells of an octree node are one byte, the
/// next level is one word, and a brick is a node three levels above the cells.
struct VoxelBrick {
  std::uint64_t code = 0;  ///< Morton code of the brick's place among the bricks [1]
  std::array<std::uint64_t, 8> passed{};
  std::array<std::uint64_t, 8> ended{};
};

/// Sets of cells, stored only where there are any. A cell is one bit however many rays meet it:
/// what OctoMap does with a hash set of keys per scan, at a small share of the cost.
class VoxelBricks {
 public:
  static constexpr int kKeyLimit = 65536;  ///< keys run from 0 to this, exclusive [1]

  /// The brick that holds the cell, made when missing; valid until the next call.
  VoxelBrick& brick_of(const CellKey& cell);

  /// Place of the cell's bit within its brick, 0 to 511.
  static unsigned bit_of(const CellKey& cell) {
    return kSpread[cell[0] & 7] | (kSpread[cell[1] & 7] << 1) | (kSpread[cell[2] & 7] << 2);
  }

  void mark_ended(const CellKey& cell);

  /// Adds the cells of `more`.
  void merge(const VoxelBricks& more);

  /// All bricks in Morton order; cells where a ray ended no longer count as passed.
  std::vector<VoxelBrick> take_sorted();

 private:
  static constexpr std::array<unsigned, 8> kSpread = {0, 1, 8, 9, 64, 65, 72, 73};

  VoxelBrick& find_or_add(std::uint64_t code);
  void grow();

  std::vector<VoxelBrick> bricks_;
  std::vector<std::uint32_t> slots_;  ///< open addressing: index of a brick + 1, 0 = empty
};

}  // namespace facula
