// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/reconstruct/mesh/distance_volume.hpp>

#include <cstddef>
#include <vector>

namespace facula {

/// A block's own bricks, and those it needs besides to draw its cells: one layer above them.
struct BrickBlock {
  BrickBox own;
  BrickBox needed;
  std::size_t bricks = 0;  ///< of `needed` that exist [1]
};

/// Boxes that do not overlap and hold every brick once, each with at most `most` bricks needed (or
/// a single brick of its own). Halves the bricks along the longest side until they fit.
std::vector<BrickBlock> split_into_blocks(std::vector<BrickPlace> bricks, std::size_t most);

}  // namespace facula
