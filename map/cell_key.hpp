// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace facula {

/// Address of a cell of an octree of depth 16: cells counted from the corner of space, per axis, 0
/// to 65535. The cell that begins at 0 m has the key 32768.
using CellKey = std::array<int, 3>;

constexpr int kKeyLimit = 65536;             ///< keys are below this [1]
constexpr int kCentreKey = kKeyLimit / 2;    ///< of the cells that begin at 0 m [1]
constexpr int kTreeDepth = 16;               ///< levels between the whole space and a cell [1]
constexpr int kBrickEdge = 8;                ///< cells along a brick [1]
constexpr int kBrickLevel = 3;               ///< levels between a brick and a cell [1]
constexpr std::size_t kCellsPerBrick = 512;  ///< [1]

/// Bit i of a 13-bit number to bit 3 i.
inline std::uint64_t spread_bits(std::uint64_t v) {
  v = (v | (v << 16)) & 0x0000ff0000ffULL;
  v = (v | (v << 8)) & 0x00f00f00f00fULL;
  v = (v | (v << 4)) & 0x0c30c30c30c3ULL;
  return (v | (v << 2)) & 0x249249249249ULL;
}

/// Bit 3 i of a number to bit i: the way back.
inline std::uint64_t gather_bits(std::uint64_t v) {
  v &= 0x249249249249ULL;
  v = (v | (v >> 2)) & 0x0c30c30c30c3ULL;
  v = (v | (v >> 4)) & 0x00f00f00f00fULL;
  v = (v | (v >> 8)) & 0x0000ff0000ffULL;
  return (v | (v >> 16)) & 0x1fff;
}

/// Morton code of the brick that holds a cell: three bits (x, y, z) per level, so that codes in
/// ascending order are the octree's own order.
inline std::uint64_t brick_code(const CellKey& cell) {
  const auto part = [&](std::size_t axis) {
    return spread_bits(static_cast<std::uint64_t>(cell[axis]) / kBrickEdge) << axis;
  };
  return part(0) | part(1) | part(2);
}

/// The cell at the low corner of a brick.
inline CellKey first_cell(std::uint64_t code) {
  const auto part = [&](int axis) {
    return static_cast<int>(gather_bits(code >> axis)) * kBrickEdge;
  };
  return {part(0), part(1), part(2)};
}

/// Place of a cell within its brick: x + 8 y + 64 z.
inline std::size_t cell_in_brick(const CellKey& cell) {
  return static_cast<std::size_t>((cell[0] & 7) | (cell[1] & 7) << 3 | (cell[2] & 7) << 6);
}

/// The cell at that place of the brick whose lowest cell is `first`: the way back.
inline CellKey cell_at(const CellKey& first, std::size_t place) {
  const auto part = [&](std::size_t axis) {
    return first[axis] + static_cast<int>(place >> (3 * axis) & 7);
  };
  return {part(0), part(1), part(2)};
}

}  // namespace facula
