// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/map/deflated.hpp>
#include <facula/map/map_blocks.hpp>

#include <algorithm>
#include <string_view>
#include <utility>

namespace facula {
namespace {

constexpr std::string_view kMagic = "FACUMAP\n";
constexpr std::uint32_t kVersion = 1;
constexpr std::size_t kStartSize = 16;
constexpr std::size_t kBlockHeadSize = 16;

/// The three numbers of a block's head that its checksum begins with.
Bytes head_of(const MapBlock& block) {
  Bytes head;
  put(head, static_cast<std::uint32_t>(block.kind));
  put(head, static_cast<std::uint32_t>(block.stored.size()));
  put(head, block.raw_size);
  return head;
}

void write_bytes(std::ostream& stream, ByteView bytes) {
  stream.write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
}

}  // namespace

void write_map_start(std::ostream& stream) {
  Bytes start;
  put_bytes(start, kMagic.data(), kMagic.size());
  put(start, kVersion);
  put(start, checksum(start));
  write_bytes(stream, start);
}

void write_map_block(std::ostream& stream, const MapBlock& block) {
  Bytes head = head_of(block);
  put(head, checksum(block.stored, checksum(head)));
  write_bytes(stream, head);
  write_bytes(stream, block.stored);
}

bool begins_map_file(ByteView bytes) {
  const ByteView magic = bytes_of_text(kMagic);
  return bytes.size() >= magic.size() && std::equal(magic.begin(), magic.end(), bytes.begin());
}

MapBlockReader::MapBlockReader(ByteView file, std::string name)
    : rest_(file), name_(std::move(name)) {
  require(begins_map_file(file),
          "'",
          name_,
          "' is not a Facula map: expected 'FACUMAP' at its beginning");
  require(file.size() >= kStartSize, "'", name_, "' is torn: it ends within its first 16 bytes");
  ByteReader start(file.subspan(kMagic.size()));
  const auto version = start.take<std::uint32_t>();
  require(start.take<std::uint32_t>() == checksum(file.first(12)),
          "'",
          name_,
          "' is damaged: the checksum of its first 16 bytes is wrong");
  require(version == kVersion,
          "'",
          name_,
          "' is of version ",
          version,
          " of Facula's maps; this program reads version ",
          kVersion);
  rest_ = file.subspan(kStartSize);
}

MapBlock MapBlockReader::next() {
  ByteReader reader(rest_);
  MapBlock block;
  block.kind = static_cast<MapBlockKind>(reader.take<std::uint32_t>());
  const auto stored_size = reader.take<std::uint32_t>();
  block.raw_size = reader.take<std::uint32_t>();
  const auto sum = reader.take<std::uint32_t>();
  block.stored = reader.take_view(stored_size);
  require(!reader.failed(),
          "'",
          name_,
          "' is torn or damaged: its block ",
          blocks_ + 1,
          " is longer than the file; copy or write it again");
  require(checksum(block.stored, checksum(rest_.first(kBlockHeadSize - 4))) == sum,
          "'",
          name_,
          "' is damaged: the checksum of its block ",
          blocks_ + 1,
          " is wrong; copy or write it again");
  require(block.raw_size <= kLargestMapBlock,
          "'",
          name_,
          "' is damaged: its block ",
          blocks_ + 1,
          " declares ",
          block.raw_size,
          " bytes");
  rest_ = rest_.subspan(kBlockHeadSize + stored_size);
  ++blocks_;
  require(block.kind != MapBlockKind::kEnd || rest_.empty(),
          "'",
          name_,
          "' is damaged: ",
          rest_.size(),
          " bytes follow its end");
  return block;
}

}  // namespace facula
