// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

namespace facula {

/// A set of cells of one brick of 8 x 8 x 8: cell (x, y, z) is bit x + 8 y of word z.
struct CellMask {
  std::array<std::uint64_t, 8> words{};

  static CellMask all() {
    CellMask mask;
    mask.words.fill(~std::uint64_t{0});
    return mask;
  }

  bool test(std::size_t cell) const { return (words[cell >> 6] >> (cell & 63) & 1) != 0; }
  void set(std::size_t cell) { words[cell >> 6] |= std::uint64_t{1} << (cell & 63); }

  bool none() const {
    std::uint64_t any = 0;
    for (const std::uint64_t word : words) any |= word;
    return any == 0;
  }
  bool full() const {
    std::uint64_t common = ~std::uint64_t{0};
    for (const std::uint64_t word : words) common &= word;
    return common == ~std::uint64_t{0};
  }
  int count() const {
    int cells = 0;
    for (const std::uint64_t word : words) cells += std::popcount(word);
    return cells;
  }

  CellMask& operator&=(const CellMask& other) {
    for (std::size_t i = 0; i < 8; ++i) words[i] &= other.words[i];
    return *this;
  }
  CellMask& operator|=(const CellMask& other) {
    for (std::size_t i = 0; i < 8; ++i) words[i] |= other.words[i];
    return *this;
  }
  friend CellMask operator&(CellMask a, const CellMask& b) { return a &= b; }
  friend CellMask operator|(CellMask a, const CellMask& b) { return a |= b; }
  friend CellMask operator~(CellMask a) {
    for (std::uint64_t& word : a.words) word = ~word;
    return a;
  }
  friend bool operator==(const CellMask&, const CellMask&) = default;
};

/// Calls visit(cell) for every cell of the set, in ascending order.
template <typename Visit>
void for_each_cell(const CellMask& mask, const Visit& visit) {
  for (std::size_t z = 0; z < 8; ++z) {
    for (std::uint64_t left = mask.words[z]; left != 0; left &= left - 1) {
      visit(64 * z + static_cast<std::size_t>(std::countr_zero(left)));
    }
  }
}

}  // namespace facula
