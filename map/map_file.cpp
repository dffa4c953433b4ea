// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/atomic_file.hpp>
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/parallel.hpp>
#include <facula/acquire/core/whole_file.hpp>
#include <facula/map/deflated.hpp>
#include <facula/map/map_blocks.hpp>
#include <facula/map/map_file.hpp>
#include <facula/map/map_settings.hpp>
#include <facula/map/packed_map.hpp>

#include <algorithm>
#include <fstream>
#include <optional>
#include <utility>

namespace facula {
namespace {

void write_deflated(std::ostream& stream, MapBlockKind kind, const Bytes& raw) {
  const Bytes stored = deflated(raw);
  write_map_block(stream, {kind, static_cast<std::uint32_t>(raw.size()), stored});
}

struct PackedBlock {
  std::uint32_t raw_size = 0;
  Bytes bytes;
};

/// Compressed side by side, in the octree's order.
std::vector<PackedBlock> pack_map(const LogOddsMap& map, int num_threads) {
  const std::vector<const LogOddsMap::Entry*> sorted = map.sorted();
  const std::span<const LogOddsMap::Entry* const> all = sorted;
  std::vector<PackedBlock> blocks((all.size() + kMapBricksPerBlock - 1) / kMapBricksPerBlock);
  const auto pack_blocks = [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const std::size_t first = i * kMapBricksPerBlock;
      const Bytes raw =
          map_bricks_bytes(all.subspan(first, std::min(kMapBricksPerBlock, all.size() - first)));
      blocks[i] = {static_cast<std::uint32_t>(raw.size()), deflated(raw)};
    }
  };
  parallel_for(blocks.size(), pack_blocks, {.num_threads = num_threads, .chunk = 1});
  return blocks;
}

void write_scan(std::ostream& stream, const KeptScan& scan) {
  write_deflated(stream, MapBlockKind::kScan, scan_record_bytes(scan));
  for (const PackedBricks& block : scan.cells.blocks) {
    write_map_block(stream, {MapBlockKind::kCells, block.raw_size, block.bytes});
  }
  for (const PackedColors& block : scan.colors) {
    write_map_block(stream, {MapBlockKind::kScanColors, block.raw_size, block.bytes});
  }
}

/// Puts the blocks of a file back together.
class MapAssembly {
 public:
  /// False after the last block.
  bool add(const MapBlock& block) {
    const Bytes raw = inflated(block.stored, block.raw_size);
    require(map_.has_value() == (block.kind != MapBlockKind::kOptions),
            "expected one block OPTS, as its first");
    require((block.kind == MapBlockKind::kCells) == (cells_to_come_ > 0) &&
                (block.kind == MapBlockKind::kScanColors) ==
                    (cells_to_come_ == 0 && colors_to_come_ > 0),
            "expected ",
            cells_to_come_,
            " more blocks of the scan's cells and ",
            colors_to_come_,
            " of its colours");
    switch (block.kind) {
      case MapBlockKind::kOptions:
        map_.emplace(parse_map_options(raw));
        return true;
      case MapBlockKind::kBricks:
        bricks_ += parse_map_bricks(raw, next_code_, map_->bricks());
        return true;
      case MapBlockKind::kColors:
        map_->colors().add(parse_color_bricks(raw, next_color_));
        return true;
      case MapBlockKind::kScanColors:
        add_scan_colors(block, raw);
        return true;
      case MapBlockKind::kScan:
        add_scan(raw);
        return true;
      case MapBlockKind::kCells:
        add_cells(block, raw);
        return true;
      case MapBlockKind::kEnd:
        finish(raw);
        return false;
    }
    fail("a block is of no known kind");
  }

  MapFile take() { return {*std::move(map_), std::move(scans_)}; }

 private:
  void add_scan(const Bytes& raw) {
    ParsedRecord parsed = parse_scan_record(raw);
    cells_to_come_ = parsed.blocks;
    colors_to_come_ = parsed.color_blocks;
    next_scan_color_ = 0;
    scans_.push_back({std::move(parsed.record), {.blocks = {}, .skipped = parsed.skipped}});
  }

  void add_scan_colors(const MapBlock& block, const Bytes& raw) {
    --colors_to_come_;
    parse_color_bricks(raw, next_scan_color_);
    scans_.back().colors.push_back(
        {block.raw_size, Bytes(block.stored.begin(), block.stored.end())});
  }

  void add_cells(const MapBlock& block, const Bytes& raw) {
    --cells_to_come_;
    const std::vector<ScanBrick> bricks = parse_scan_bricks(raw);
    std::vector<PackedBricks>& blocks = scans_.back().cells.blocks;
    require(blocks.empty() || blocks.back().last <= bricks.front().code,
            "the cells of the scan '",
            scans_.back().record.name,
            "' are not in the order of the octree");
    blocks.push_back({.first = bricks.front().code,
                      .last = bricks.back().code,
                      .raw_size = block.raw_size,
                      .bytes = Bytes(block.stored.begin(), block.stored.end())});
  }

  void finish(const Bytes& raw) {
    const MapCounts counts = parse_map_counts(raw);
    require(counts.bricks == bricks_ && counts.scans == scans_.size(),
            "its end counts ",
            counts.bricks,
            " bricks and ",
            counts.scans,
            " scans, there are ",
            bricks_,
            " and ",
            scans_.size());
  }

  std::optional<OccupancyMap> map_;
  std::vector<KeptScan> scans_;
  std::uint64_t next_code_ = 0;
  std::size_t bricks_ = 0;
  std::uint64_t cells_to_come_ = 0;
  std::uint64_t colors_to_come_ = 0;
  std::uint64_t next_color_ = 0;
  std::uint64_t next_scan_color_ = 0;
};

}  // namespace

void write_map_file(const std::filesystem::path& path,
                    const OccupancyMap& map,
                    std::span<const KeptScan> scans) {
  AtomicFile file(path);
  std::ostream& stream = file.stream();
  const std::vector<PackedBlock> blocks = pack_map(map.bricks(), map.options().num_threads);
  write_map_start(stream);
  write_deflated(stream, MapBlockKind::kOptions, map_options_bytes(map.options()));
  for (const PackedBlock& block : blocks) {
    write_map_block(stream, {MapBlockKind::kBricks, block.raw_size, block.bytes});
  }
  for (const PackedColors& block : pack_colors(map.colors().sorted())) {
    write_map_block(stream, {MapBlockKind::kColors, block.raw_size, block.bytes});
  }
  for (const KeptScan& scan : scans) write_scan(stream, scan);
  const MapCounts counts{.bricks = map.bricks().sorted().size(), .scans = scans.size()};
  write_deflated(stream, MapBlockKind::kEnd, map_counts_bytes(counts));
  file.commit();
}

MapFile parse_map_file(ByteView file, const std::string& name) {
  MapBlockReader reader(file, name);
  MapAssembly assembly;
  for (bool more = true; more;) {
    const MapBlock block = reader.next();
    try {
      more = assembly.add(block);
    } catch (const Error& reason) {
      fail("'", name, "' is damaged in its block ", reader.blocks(), ": ", reason.what());
    }
  }
  return assembly.take();
}

MapFile read_map_file(const std::filesystem::path& path) {
  return parse_map_file(bytes_of_text(read_whole_file(path)), path.string());
}

bool is_map_file(const std::filesystem::path& path) {
  std::string start(8, '\0');
  std::ifstream stream(path, std::ios::binary);
  stream.read(start.data(), static_cast<std::streamsize>(start.size()));
  return stream.gcount() == 8 && begins_map_file(bytes_of_text(start));
}

}  // namespace facula
