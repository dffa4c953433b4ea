// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/map/brick_codes.hpp>

#include <cstddef>
#include <cstdint>
#include <string>

namespace facula {

// Space is cut into blocks of 16 x 16 x 16 bricks, 128 cells along an edge. A block's number is the
// Morton code that its bricks have in common.

constexpr int kBlockLevel = 4;  ///< levels between a block and a brick [1]
constexpr std::uint64_t kBricksPerBlock = std::uint64_t{1} << (3 * kBlockLevel);  ///< [1]
constexpr std::uint64_t kBlockLimit = kBrickCodeLimit / kBricksPerBlock;  ///< numbers are below

/// The block that a brick (brick_code()) lies in.
constexpr std::uint64_t block_of(std::uint64_t brick) {
  return brick >> (3 * kBlockLevel);
}

/// Which of `owners` has the block: spread evenly however the blocks lie (the generator SplitMix64
/// seeded with the block, whose last step is Stafford's mixing function 13).
constexpr std::size_t owner_of_block(std::uint64_t block, std::size_t owners) {
  std::uint64_t mixed = block + 0x9e3779b97f4a7c15ULL;
  mixed = (mixed ^ (mixed >> 30)) * 0xbf58476d1ce4e5b9ULL;
  mixed = (mixed ^ (mixed >> 27)) * 0x94d049bb133111ebULL;
  return static_cast<std::size_t>((mixed ^ (mixed >> 31)) % owners);
}

/// "block_256_255_256.ot": blocks counted along x, y and z from the corner of space; the one that
/// begins at 0 m is 256.
inline std::string block_file_name(std::uint64_t block) {
  const auto place = [&](int axis) { return std::to_string(gather_bits(block >> axis)); };
  return "block_" + place(0) + "_" + place(1) + "_" + place(2) + ".ot";
}

}  // namespace facula
