// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/map/cell_key.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace facula {

/// A box of cells with one bit each, rows along x: what rays mark while they are walked. Corner and
/// sizes are multiples of a brick's edge; the corner may lie below key 0.
struct DenseBits {
  std::array<std::int64_t, 3> corner{};  ///< key of the first cell, per axis
  std::array<std::int64_t, 3> size{};    ///< cells per axis
  std::vector<std::uint64_t> words;

  std::int64_t row() const { return size[0]; }
  std::int64_t layer() const { return size[0] * size[1]; }
  void clear() { words.assign(static_cast<std::size_t>(layer() * size[2] / 64 + 1), 0); }

  /// The 8 cells (x .. x + 7, y, z) of the box; x is a multiple of 8.
  std::uint8_t byte(std::int64_t x, std::int64_t y, std::int64_t z) const {
    const std::int64_t bit = x + row() * y + layer() * z;
    return static_cast<std::uint8_t>(words[static_cast<std::size_t>(bit >> 6)] >> (bit & 63));
  }
};

/// Rays from origins to points, x y z of each one after the other [m].
struct RayBlock {
  const float* origins;
  const float* points;
  std::size_t begin = 0;
  std::size_t end = 0;
};

struct DenseCast {
  double resolution = 0;
  double max_range = 0;  ///< 0 = no limit [m]
  DenseBits passed;      ///< also cells that rays end in
  DenseBits ended;       ///< of the same box
  std::size_t skipped = 0;

  /// Walks rays, as many at once as the processor has lanes of doubles; the cells are those of
  /// walk_ray(). All first and last cells must lie at least 8 cells within the box.
  void walk(const RayBlock& rays);
};

}  // namespace facula
