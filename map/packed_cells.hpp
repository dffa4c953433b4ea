// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/byte_sequence.hpp>
#include <facula/map/scan_cells.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace facula {

/// Bricks of a scan, compressed.
struct PackedBricks {
  std::uint64_t first = 0;     ///< code of the first brick
  std::uint64_t last = 0;      ///< and of the last
  std::uint32_t raw_size = 0;  ///< what `bytes` stand for [bytes]
  Bytes bytes;                 ///< deflated scan_bricks_bytes()
};

/// All that one scan says about space, compressed in blocks that can be opened one by one: of
/// 500 000 rays in a room of 8 x 6 x 3 m a tenth to a sixteenth of ScanCells at 5 and 2 cm.
struct PackedCells {
  static constexpr std::size_t kBricksPerBlock = 512;  ///< at most [1]

  std::vector<PackedBricks> blocks;  ///< in ascending order
  std::size_t skipped = 0;           ///< as ScanCells counts them [1]

  std::size_t memory_usage() const;  ///< [bytes]
};

/// The same for any number of threads.
PackedCells pack(const ScanCells& cells, int num_threads = 0);

/// The way back, bit for bit.
ScanCells unpack(const PackedCells& cells);

/// One block; throws Error where its bytes are damaged.
std::vector<ScanBrick> unpack(const PackedBricks& block);

/// A block of bricks before compression: number of bricks (LEB128), then per brick eight times what
/// its code adds to the one before plus 8 minus `eighths` (LEB128), and its masks `passed` and
/// `ended` (put_mask()).
Bytes scan_bricks_bytes(std::span<const ScanBrick> bricks);

/// The way back; throws Error unless the bytes are such a block, exactly.
std::vector<ScanBrick> parse_scan_bricks(ByteView bytes);

}  // namespace facula
