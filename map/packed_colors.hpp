// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/byte_sequence.hpp>
#include <facula/map/cell_colors.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace facula {

/// Coloured bricks, compressed.
struct PackedColors {
  std::uint32_t raw_size = 0;  ///< what `bytes` stand for [bytes]
  Bytes bytes;                 ///< deflated color_bricks_bytes()
};

/// Most coloured bricks in a block [1]: at most 1 MB before compression.
constexpr std::size_t kColorBricksPerBlock = 48;

/// Bricks in ascending order of their codes as compressed blocks.
std::vector<PackedColors> pack_colors(std::span<const ColorBrick* const> bricks);
std::vector<PackedColors> pack_colors(std::span<const ColorBrick> bricks);

/// The way back, exactly; throws Error where bytes are damaged.
std::vector<ColorBrick> unpack_colors(std::span<const PackedColors> blocks);

/// A block before compression: number of bricks (LEB128), then per brick what its code adds to the
/// code after the one before (LEB128), the coloured cells (put_mask()), and per cell the number of
/// points and the sums of red, green and blue (LEB128 each).
Bytes color_bricks_bytes(std::span<const ColorBrick* const> bricks);

/// The way back; throws Error unless the bytes are such a block, exactly, whose first code is at
/// least `next`, which is moved behind the block's last.
std::vector<ColorBrick> parse_color_bricks(ByteView bytes, std::uint64_t& next);

}  // namespace facula
