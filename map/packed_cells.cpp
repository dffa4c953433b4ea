// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/parallel.hpp>
#include <facula/map/brick_codes.hpp>
#include <facula/map/deflated.hpp>
#include <facula/map/mask_bytes.hpp>
#include <facula/map/packed_cells.hpp>

#include <algorithm>

namespace facula {
namespace {

/// What hits may count: 8 to 1 eighths.
constexpr std::uint64_t kSharesOfHit = 8;

}  // namespace

std::size_t PackedCells::memory_usage() const {
  std::size_t bytes = sizeof *this + blocks.capacity() * sizeof(PackedBricks);
  for (const PackedBricks& block : blocks) bytes += block.bytes.capacity();
  return bytes;
}

Bytes scan_bricks_bytes(std::span<const ScanBrick> bricks) {
  Bytes bytes;
  bytes.reserve(32 * bricks.size());
  put_varint(bytes, bricks.size());
  std::uint64_t before = 0;
  for (const ScanBrick& brick : bricks) {
    put_varint(bytes, kSharesOfHit * (brick.code - before) + (ScanBrick::kSure - brick.eighths));
    before = brick.code;
    put_mask(bytes, brick.passed);
    put_mask(bytes, brick.ended);
  }
  return bytes;
}

std::vector<ScanBrick> parse_scan_bricks(ByteView bytes) {
  ByteReader reader(bytes);
  const std::uint64_t count = take_varint(reader);
  require(count >= 1 && count <= PackedCells::kBricksPerBlock,
          "expected 1 to ",
          PackedCells::kBricksPerBlock,
          " bricks in a block, got ",
          count);
  std::vector<ScanBrick> bricks(count);
  std::uint64_t before = 0;
  for (ScanBrick& brick : bricks) {
    const std::uint64_t number = take_varint(reader);
    require(number / kSharesOfHit < kBrickCodeLimit - before,
            "a brick lies outside the 65536 cells of an axis");
    before += number / kSharesOfHit;
    brick.code = before;
    brick.eighths = static_cast<std::uint8_t>(ScanBrick::kSure - number % kSharesOfHit);
    brick.passed = take_mask(reader);
    brick.ended = take_mask(reader);
    require((brick.passed & brick.ended).none(), "a cell is both passed and ended in");
  }
  require(!reader.failed() && reader.left() == 0,
          "a block of ",
          bytes.size(),
          " bytes does not hold the ",
          count,
          " bricks that it names");
  return bricks;
}

PackedCells pack(const ScanCells& cells, int num_threads) {
  PackedCells packed;
  packed.skipped = cells.skipped;
  const std::span<const ScanBrick> all = cells.bricks;
  constexpr std::size_t kCount = PackedCells::kBricksPerBlock;
  packed.blocks.resize((all.size() + kCount - 1) / kCount);
  const auto pack_blocks = [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto part = all.subspan(i * kCount, std::min(kCount, all.size() - i * kCount));
      const Bytes raw = scan_bricks_bytes(part);
      packed.blocks[i] = {.first = part.front().code,
                          .last = part.back().code,
                          .raw_size = static_cast<std::uint32_t>(raw.size()),
                          .bytes = deflated(raw)};
      packed.blocks[i].bytes.shrink_to_fit();
    }
  };
  parallel_for(packed.blocks.size(), pack_blocks, {.num_threads = num_threads, .chunk = 1});
  return packed;
}

std::vector<ScanBrick> unpack(const PackedBricks& block) {
  return parse_scan_bricks(inflated(block.bytes, block.raw_size));
}

ScanCells unpack(const PackedCells& cells) {
  ScanCells result;
  result.skipped = cells.skipped;
  for (const PackedBricks& block : cells.blocks) {
    const std::vector<ScanBrick> bricks = unpack(block);
    result.bricks.insert(result.bricks.end(), bricks.begin(), bricks.end());
  }
  return result;
}

}  // namespace facula
