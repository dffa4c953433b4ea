// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/map/cell_key.hpp>
#include <facula/map/cell_mask.hpp>

#include <algorithm>
#include <cmath>

namespace facula {

/// Keys along z of layers of cells: begin, begin + 1, ..., end - 1.
struct CellLayers {
  int begin = 0;
  int end = 0;

  bool holds(int z) const { return z >= begin && z < end; }
};

/// The layers that share more than a face with the heights from `low` to `high` (world z, [m]).
inline CellLayers layers_between(double low, double high, double resolution) {
  // Heights at a face of a cell come from doubles that may be off by a rounding.
  constexpr double kSlack = 1e-6;
  const auto key = [](double layer) {
    return static_cast<int>(std::clamp(layer + kCentreKey, 0.0, static_cast<double>(kKeyLimit)));
  };
  return {key(std::floor(low / resolution + kSlack)), key(std::ceil(high / resolution - kSlack))};
}

/// The cells of a brick, whose lowest layer is `first_z`, that lie in the layers.
inline CellMask mask_of(const CellLayers& layers, int first_z) {
  CellMask mask;
  for (std::size_t z = 0; z < 8; ++z) {
    if (layers.holds(first_z + static_cast<int>(z))) mask.words[z] = ~std::uint64_t{0};
  }
  return mask;
}

/// Bit x + 8 y where the column of the brick has a cell of the set.
inline std::uint64_t columns_of(const CellMask& mask) {
  std::uint64_t columns = 0;
  for (const std::uint64_t word : mask.words) columns |= word;
  return columns;
}

}  // namespace facula
