// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/parallel.hpp>
#include <facula/apps/map_mpi/scan_parts.hpp>
#include <facula/map/packed_cells.hpp>
#include <facula/map/space_block.hpp>

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <span>

namespace facula {
namespace {

Bytes part_of(std::span<const ScanBrick> bricks) {
  constexpr std::size_t kCount = PackedCells::kBricksPerBlock;
  Bytes part;
  for (std::size_t i = 0; i < bricks.size(); i += kCount) {
    const Bytes block = scan_bricks_bytes(bricks.subspan(i, std::min(kCount, bricks.size() - i)));
    put(part, static_cast<std::uint32_t>(block.size()));
    put_bytes(part, block.data(), block.size());
  }
  return part;
}

std::vector<ByteView> blocks_of_part(ByteView part) {
  std::vector<ByteView> blocks;
  ByteReader reader(part);
  while (reader.left() > 0) {
    const ByteView block = reader.take_view(reader.take<std::uint32_t>());
    require(!reader.failed() && !block.empty(),
            "expected the bricks of a scan from another rank, got bytes that are none");
    blocks.push_back(block);
  }
  return blocks;
}

}  // namespace

std::vector<Bytes> parts_of_scan(const ScanCells& scan, std::size_t owners, int num_threads) {
  std::vector<std::vector<ScanBrick>> dealt(owners);
  for (const ScanBrick& brick : scan.bricks) {
    dealt[owner_of_block(block_of(brick.code), owners)].push_back(brick);
  }
  std::vector<Bytes> parts(owners);
  const auto pack_parts = [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) parts[i] = part_of(dealt[i]);
  };
  parallel_for(owners, pack_parts, {.num_threads = num_threads, .chunk = 1});
  return parts;
}

std::vector<ScanBrick> bricks_of_part(ByteView part, int num_threads) {
  const std::vector<ByteView> blocks = blocks_of_part(part);
  std::vector<std::vector<ScanBrick>> opened(blocks.size());
  const auto open_blocks = [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) opened[i] = parse_scan_bricks(blocks[i]);
  };
  parallel_for(blocks.size(), open_blocks, {.num_threads = num_threads, .chunk = 1});
  std::vector<ScanBrick> bricks;
  for (const auto& block : opened)
    std::copy(block.begin(), block.end(), std::back_inserter(bricks));
  return bricks;
}

}  // namespace facula
