// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/map/voxel_bricks.hpp>

#include <algorithm>
#include <bit>
#include <utility>

namespace facula {
namespace {

/// Moves bit i of a 13-bit number to bit 3 i.
std::uint64_t spread(std::uint64_t v) {
  v = (v | (v << 16)) & 0x0000ff0000ffULL;
  v = (v | (v << 8)) & 0x00f00f00f00fULL;
  v = (v | (v << 4)) & 0x0c30c30c30c3ULL;
  return (v | (v << 2)) & 0x249249249249ULL;
}

std::uint64_t morton_code(std::uint64_t brick) {
  const auto place = [&](int axis) {
    return spread(brick >> (axis * PackedCell::kShift + 3) & 0x1fff) << axis;
  };
  return place(0) | place(1) | place(2);
}

/// From bit x + 8 y of word z to Morton order.
void sort_bits(std::array<std::uint64_t, 8>& words) {
  constexpr std::array<unsigned, 8> kSpread = {0, 1, 8, 9, 64, 65, 72, 73};
  std::array<std::uint64_t, 8> sorted{};
  for (unsigned z = 0; z < 8; ++z) {
    for (std::uint64_t left = words[z]; left != 0; left &= left - 1) {
      const auto bit = static_cast<unsigned>(std::countr_zero(left));
      const unsigned place = kSpread[bit & 7] | kSpread[bit >> 3] << 1 | kSpread[z] << 2;
      sorted[place >> 6] |= std::uint64_t{1} << (place & 63);
    }
  }
  words = sorted;
}

/// Fibonacci hashing (Knuth, TAOCP 3, 6.4) of the folded number, so that all three axes reach the
/// low bits of the result.
std::size_t hash(std::uint64_t code) {
  return static_cast<std::size_t>(((code ^ (code >> 32)) * 0x9e3779b97f4a7c15ULL) >> 32);
}

}  // namespace

void VoxelBricks::merge(const VoxelBricks& more) {
  for (const VoxelBrick& theirs : more.bricks_) {
    VoxelBrick& ours = find_or_add(theirs.code);
    for (std::size_t i = 0; i < ours.passed.size(); ++i) {
      ours.passed[i] |= theirs.passed[i];
      ours.ended[i] |= theirs.ended[i];
    }
  }
}

std::vector<VoxelBrick> VoxelBricks::take_sorted() {
  slots_.clear();
  std::vector<VoxelBrick> sorted = std::exchange(bricks_, {});
  for (VoxelBrick& brick : sorted) {
    brick.code = morton_code(brick.code);
    for (std::size_t i = 0; i < brick.passed.size(); ++i) brick.passed[i] &= ~brick.ended[i];
    sort_bits(brick.passed);
    sort_bits(brick.ended);
  }
  std::sort(sorted.begin(), sorted.end(), [](const VoxelBrick& a, const VoxelBrick& b) {
    return a.code < b.code;
  });
  return sorted;
}

VoxelBrick& VoxelBricks::find_or_add(std::uint64_t code) {
  if (2 * (bricks_.size() + 1) > slots_.size()) grow();
  const std::size_t mask = slots_.size() - 1;
  std::size_t slot = hash(code) & mask;
  while (slots_[slot] != 0) {
    VoxelBrick& brick = bricks_[slots_[slot] - 1];
    if (brick.code == code) return brick;
    slot = (slot + 1) & mask;
  }
  bricks_.emplace_back().code = code;
  slots_[slot] = static_cast<std::uint32_t>(bricks_.size());
  return bricks_.back();
}

void VoxelBricks::grow() {
  slots_.assign(std::max<std::size_t>(256, 2 * slots_.size()), 0);
  const std::size_t mask = slots_.size() - 1;
  for (std::size_t i = 0; i < bricks_.size(); ++i) {
    std::size_t slot = hash(bricks_[i].code) & mask;
    while (slots_[slot] != 0) slot = (slot + 1) & mask;
    slots_[slot] = static_cast<std::uint32_t>(i + 1);
  }
}

}  // namespace facula
