// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/byte_sequence.hpp>
#include <facula/map/occupancy_map.hpp>
#include <facula/map/scan_map.hpp>

#include <cstddef>
#include <cstdint>

namespace facula {

// The small blocks of a .fmap file before compression; docs/map_files.md has their layout. The
// parsers throw Error unless the bytes are such a block, exactly, with values in their ranges.

Bytes map_options_bytes(const OccupancyOptions& options);
OccupancyOptions parse_map_options(ByteView bytes);

/// A scan's record in front of its blocks of cells.
struct ParsedRecord {
  ScanRecord record;
  std::uint64_t skipped = 0;       ///< points [1]
  std::uint64_t blocks = 0;        ///< of cells that follow [1]
  std::uint64_t color_blocks = 0;  ///< of colours behind them [1]
};
Bytes scan_record_bytes(const KeptScan& scan);
ParsedRecord parse_scan_record(ByteView bytes);

/// What the end of a file counts.
struct MapCounts {
  std::uint64_t bricks = 0;
  std::uint64_t scans = 0;
};
Bytes map_counts_bytes(const MapCounts& counts);
MapCounts parse_map_counts(ByteView bytes);

}  // namespace facula
