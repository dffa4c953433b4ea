// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/byte_sequence.hpp>

#include <cstddef>
#include <cstdint>
#include <ostream>
#include <string>

namespace facula {

/// What a block of a .fmap file is about, as four letters.
enum class MapBlockKind : std::uint32_t {
  kOptions = 0x5354504f,     ///< "OPTS"
  kBricks = 0x4b435242,      ///< "BRCK"
  kScan = 0x4e414353,        ///< "SCAN"
  kCells = 0x4c4c4543,       ///< "CELL"
  kColors = 0x524c4f43,      ///< "COLR"
  kScanColors = 0x4c4f4353,  ///< "SCOL"
  kEnd = 0x20444e45          ///< "END "
};

/// A block as it lies in the file.
struct MapBlock {
  MapBlockKind kind = MapBlockKind::kEnd;
  std::uint32_t raw_size = 0;  ///< what `stored` stands for [bytes]
  ByteView stored;             ///< deflated
};

/// Largest block before compression [bytes].
constexpr std::uint32_t kLargestMapBlock = 1U << 20;

/// Writes the 16 bytes in front of the blocks.
void write_map_start(std::ostream& stream);

/// Writes a block with its checksum.
void write_map_block(std::ostream& stream, const MapBlock& block);

/// The blocks of a file, one after the other. Throws Error where they are torn or damaged; what()
/// begins with the file's name.
class MapBlockReader {
 public:
  MapBlockReader(ByteView file, std::string name);

  /// The next block, whose checksum is right; the last one is kEnd, behind which the file ends.
  MapBlock next();

  std::size_t blocks() const { return blocks_; }  ///< read so far [1]

 private:
  ByteView rest_;
  std::string name_;
  std::size_t blocks_ = 0;
};

/// Whether the bytes begin as a .fmap file.
bool begins_map_file(ByteView bytes);

}  // namespace facula
