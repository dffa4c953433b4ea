// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/map/brick_codes.hpp>
#include <facula/map/deflated.hpp>
#include <facula/map/mask_bytes.hpp>
#include <facula/map/packed_colors.hpp>

#include <algorithm>

namespace facula {
namespace {

/// So that sums of a file, added up, stay within 64 bits.
constexpr std::uint64_t kMostPoints = std::uint64_t{1} << 40;

ColorSum take_sum(ByteReader& reader) {
  ColorSum sum;
  sum.count = take_varint(reader);
  require(
      sum.count >= 1 && sum.count <= kMostPoints, "a coloured cell counts ", sum.count, " points");
  for (std::uint64_t& part : sum.sum) {
    part = take_varint(reader);
    require(part <= 255 * sum.count, "a colour of a cell is above 255");
  }
  return sum;
}

}  // namespace

std::vector<PackedColors> pack_colors(std::span<const ColorBrick* const> bricks) {
  std::vector<PackedColors> blocks;
  for (std::size_t i = 0; i < bricks.size(); i += kColorBricksPerBlock) {
    const Bytes raw =
        color_bricks_bytes(bricks.subspan(i, std::min(kColorBricksPerBlock, bricks.size() - i)));
    blocks.push_back({static_cast<std::uint32_t>(raw.size()), deflated(raw)});
    blocks.back().bytes.shrink_to_fit();
  }
  return blocks;
}

std::vector<PackedColors> pack_colors(std::span<const ColorBrick> bricks) {
  std::vector<const ColorBrick*> pointers;
  pointers.reserve(bricks.size());
  for (const ColorBrick& brick : bricks) pointers.push_back(&brick);
  return pack_colors(pointers);
}

std::vector<ColorBrick> unpack_colors(std::span<const PackedColors> blocks) {
  std::vector<ColorBrick> bricks;
  std::uint64_t next = 0;
  for (const PackedColors& block : blocks) {
    for (ColorBrick& brick : parse_color_bricks(inflated(block.bytes, block.raw_size), next)) {
      bricks.push_back(std::move(brick));
    }
  }
  return bricks;
}

Bytes color_bricks_bytes(std::span<const ColorBrick* const> bricks) {
  Bytes bytes;
  put_varint(bytes, bricks.size());
  BrickCodeWriter codes;
  for (const ColorBrick* brick : bricks) {
    codes.put(bytes, brick->code);
    put_mask(bytes, brick->cells);
    for (const ColorSum& sum : brick->sums) {
      put_varint(bytes, sum.count);
      for (const std::uint64_t part : sum.sum) put_varint(bytes, part);
    }
  }
  return bytes;
}

std::vector<ColorBrick> parse_color_bricks(ByteView bytes, std::uint64_t& next) {
  ByteReader reader(bytes);
  const std::uint64_t count = take_varint(reader);
  require(count >= 1 && count <= kColorBricksPerBlock,
          "expected 1 to ",
          kColorBricksPerBlock,
          " coloured bricks in a block, got ",
          count);
  std::vector<ColorBrick> bricks(count);
  BrickCodeReader codes;
  for (ColorBrick& brick : bricks) {
    brick.code = codes.take(reader);
    require(brick.code >= next, "a coloured brick stands twice, or not in the octree's order");
    next = brick.code + 1;
    brick.cells = take_mask(reader);
    require(!brick.cells.none(), "a coloured brick has no coloured cell");
    for_each_cell(brick.cells, [&](std::size_t) { brick.sums.push_back(take_sum(reader)); });
  }
  require(!reader.failed() && reader.left() == 0, "a block of colours is of another length");
  return bricks;
}

}  // namespace facula
