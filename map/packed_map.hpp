// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/byte_sequence.hpp>
#include <facula/map/log_odds_map.hpp>

#include <cstddef>
#include <cstdint>
#include <span>

namespace facula {

/// Most bricks of log-odds in a block [1]: at most 810 kB before compression.
constexpr std::size_t kMapBricksPerBlock = 256;

/// A block of bricks before compression: number of bricks (LEB128), then per brick
///   what its code adds to the code after the one before (LEB128),
///   the number n of different log-odds, 1 to 512 (LEB128),
///   which cells are known (put_mask()),
///   n log-odds (float) in ascending order of their bits,
///   n of 2 to 16: for each bit of n - 1, lowest first, the cells whose value has a number with
///   that bit (put_mask()); n above 16: the number of each known cell's value (16 bits).
Bytes map_bricks_bytes(std::span<const LogOddsMap::Entry* const> bricks);

/// Puts the bricks of a block into the map; returns how many. `next` is the least code that may
/// come, and is moved behind the block's last. Throws Error unless the bytes are such a block,
/// exactly, and all log-odds are finite.
std::size_t parse_map_bricks(ByteView bytes, std::uint64_t& next, LogOddsMap& map);

}  // namespace facula
