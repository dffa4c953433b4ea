// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/map/occupancy_map.hpp>

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace facula {

/// The file of one block of a map, as the index has it.
struct BlockRecord {
  std::uint64_t block = 0;     ///< block_of() its bricks
  std::uint64_t size = 0;      ///< [bytes]
  std::uint32_t checksum = 0;  ///< CRC-32 of all of it
  std::uint64_t bricks = 0;    ///< bricks with a known cell, 1 to 4096 [1]

  friend bool operator==(const BlockRecord&, const BlockRecord&) = default;
};

/// What lies beside the blocks of a map: how it was made, and which blocks there are.
struct BlockIndex {
  OccupancyOptions options;         ///< but for box and threads
  std::uint64_t scans = 0;          ///< [1]
  std::uint64_t points = 0;         ///< of all scans [1]
  std::vector<BlockRecord> blocks;  ///< by ascending number
};

/// The first line of an index.
constexpr std::string_view kBlockIndexMark = "facula map in blocks 1";

/// The index as text: the mark, a line "key value" for each field, a line "file size checksum
/// bricks" for each block, and the checksum of all that (docs/map_mpi.md).
std::string block_index_text(const BlockIndex& index);

/// The way back. `name` is the file's name for messages. Throws Error where the text is not such an
/// index, is of a later version, ends early, or is damaged.
BlockIndex parse_block_index(std::string_view text, const std::string& name);

}  // namespace facula
