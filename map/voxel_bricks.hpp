// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace facula {

/// Address of a cell of an octree of depth 16: cells counted from the corner of space, per axis.
using CellKey = std::array<int, 3>;

/// A cell's three keys side by side in one number, 21 bits each, so that a step along an axis is
/// one addition. A step off the 65536 keys sets bit 16 of its axis (below 0 too, by the borrow).
struct PackedCell {
  static constexpr int kShift = 21;
  static constexpr std::uint64_t kEachAxis = 1 | 1ULL << kShift | 1ULL << 2 * kShift;
  static constexpr std::uint64_t kWithinBrick = 7 * kEachAxis;
  static constexpr std::uint64_t kOffGrid = 0x10000 * kEachAxis;

  std::uint64_t bits = 0;

  static PackedCell of(const CellKey& key) {
    const auto part = [&](std::size_t i) { return static_cast<std::uint64_t>(key[i]); };
    return {part(0) | part(1) << kShift | part(2) << 2 * kShift};
  }
  std::uint64_t brick() const { return bits & ~kWithinBrick; }
  std::size_t word() const { return bits >> 2 * kShift & 7; }
  std::uint64_t bit() const { return 1ULL << ((bits & 7) | (bits >> (kShift - 3) & 0x38)); }
};

/// 8 x 8 x 8 cells with one bit each for "a ray passed" and "a ray ended". While rays are walked,
/// cell (x, y, z) of a brick is bit x + 8 y of word z. take_sorted() puts the bits into Morton
/// order (three bits x, y, z per level), so that the eight cells of an octree node are one byte,
/// the next level is one word, and a brick is a node three levels above the cells.
struct VoxelBrick {
  std::uint64_t code = 0;  ///< PackedCell::brick(); sorted: Morton code among the bricks [1]
  std::array<std::uint64_t, 8> passed{};
  std::array<std::uint64_t, 8> ended{};
};

/// Sets of cells, stored only where there are any. A cell is one bit however many rays meet it:
/// what OctoMap does with a hash set of keys per scan, at a small share of the cost.
class VoxelBricks {
 public:
  static constexpr int kKeyLimit = 65536;  ///< keys run from 0 to this, exclusive [1]

  /// The brick that holds the cell, made when missing; valid until the next call.
  VoxelBrick& brick_of(PackedCell cell) { return find_or_add(cell.brick()); }

  void mark_ended(PackedCell cell) { brick_of(cell).ended[cell.word()] |= cell.bit(); }

  /// Adds the cells of `more`.
  void merge(const VoxelBricks& more);

  /// All bricks in Morton order, inside and out, and leaves this empty; cells where a ray ended no
  /// longer count as passed.
  std::vector<VoxelBrick> take_sorted();

 private:
  VoxelBrick& find_or_add(std::uint64_t code);
  void grow();

  std::vector<VoxelBrick> bricks_;
  std::vector<std::uint32_t> slots_;  ///< open addressing: index of a brick + 1, 0 = empty
};

}  // namespace facula
