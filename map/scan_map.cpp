// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/parallel.hpp>
#include <facula/map/scan_map.hpp>

#include <algorithm>
#include <set>
#include <utility>

namespace facula {
namespace {

/// Names of scans are a part of sentences and of files.
constexpr std::size_t kLongestName = 4096;

void append_codes(const ScanCells& cells, std::vector<std::uint64_t>& codes) {
  for (const ScanBrick& brick : cells.bricks) codes.push_back(brick.code);
}

void sort_unique(std::vector<std::uint64_t>& codes) {
  std::sort(codes.begin(), codes.end());
  codes.erase(std::unique(codes.begin(), codes.end()), codes.end());
}

/// Scans that are opened side by side.
constexpr std::size_t kBatch = 32;

/// What a scan says about some bricks, and the blocks that were opened for it.
struct Touched {
  std::vector<ScanBrick> bricks;
  std::size_t blocks = 0;
};

/// The bricks of a scan that are among the ascending `codes`; opens only blocks that may hold one.
Touched bricks_among(const PackedCells& cells, const std::vector<std::uint64_t>& codes) {
  Touched result;
  for (const PackedBricks& block : cells.blocks) {
    auto code = std::lower_bound(codes.begin(), codes.end(), block.first);
    if (code == codes.end() || *code > block.last) continue;
    ++result.blocks;
    for (const ScanBrick& brick : unpack(block)) {
      while (code != codes.end() && *code < brick.code) ++code;
      if (code != codes.end() && *code == brick.code) result.bricks.push_back(brick);
    }
  }
  return result;
}

}  // namespace

ScanMap::ScanMap(const OccupancyOptions& options) : map_(options) {}

ScanMap::ScanMap(OccupancyMap map, std::vector<KeptScan> scans)
    : map_(std::move(map)), scans_(std::move(scans)) {
  std::set<std::string_view> names;
  for (const KeptScan& scan : scans_) {
    check(scan.record);
    require(names.insert(scan.record.name).second,
            "a map cannot keep two scans by the name '",
            scan.record.name,
            "'");
  }
}

void ScanMap::check(const ScanRecord& record) const {
  require(!record.name.empty() && record.name.size() <= kLongestName,
          "a scan that a map keeps needs a name of 1 to ",
          kLongestName,
          " bytes, got ",
          record.name.size());
  require(record.cast.resolution == map_.resolution(),
          "the scan '",
          record.name,
          "' was cast into cells of ",
          record.cast.resolution,
          " m, the map has cells of ",
          map_.resolution(),
          " m; cast it again");
}

void ScanMap::add(const ScanRecord& record,
                  const ScanCells& cells,
                  std::span<const ColorBrick> colors) {
  check(record);
  const bool taken = std::any_of(scans_.begin(), scans_.end(), [&](const KeptScan& scan) {
    return scan.record.name == record.name;
  });
  require(!taken, "the map keeps a scan by the name '", record.name, "' already; replace that one");
  scans_.push_back({record, pack(cells, map_.options().num_threads), pack_colors(colors)});
  map_.insert(cells);
  map_.colors().add(colors);
}

void ScanMap::add(const std::string& name,
                  const PointCloud& cloud,
                  const RigidTransform& world_from_scan) {
  const CastOptions cast = map_.options().cast();
  const PointCloud in_world = transformed(cloud, world_from_scan);
  const ScanCells cells = cells_of_scan(in_world, cast);
  add({name, world_from_scan, cloud.size(), cast}, cells, colors_of_scan(in_world, cast));
}

std::size_t ScanMap::place_of(std::string_view name) const {
  const auto scan = std::find_if(
      scans_.begin(), scans_.end(), [&](const KeptScan& kept) { return kept.record.name == name; });
  require(scan != scans_.end(),
          "the map keeps no scan by the name '",
          name,
          "'; it keeps ",
          scans_.size(),
          scans_.empty() ? "" : ", the first is '",
          scans_.empty() ? "" : scans_.front().record.name,
          scans_.empty() ? "" : "'");
  return static_cast<std::size_t>(scan - scans_.begin());
}

Rebuild ScanMap::remove(std::string_view name) {
  const std::size_t place = place_of(name);
  std::vector<std::uint64_t> codes;
  append_codes(unpack(scans_[place].cells), codes);
  map_.colors().subtract(unpack_colors(scans_[place].colors));
  scans_.erase(scans_.begin() + static_cast<std::ptrdiff_t>(place));
  return rebuild(std::move(codes));
}

Rebuild ScanMap::replace(const ScanRecord& record,
                         const ScanCells& cells,
                         std::span<const ColorBrick> colors) {
  check(record);
  KeptScan& scan = scans_[place_of(record.name)];
  std::vector<std::uint64_t> codes;
  append_codes(unpack(scan.cells), codes);
  append_codes(cells, codes);
  map_.colors().subtract(unpack_colors(scan.colors));
  map_.colors().add(colors);
  scan = {record, pack(cells, map_.options().num_threads), pack_colors(colors)};
  return rebuild(std::move(codes));
}

Rebuild ScanMap::rebuild(std::vector<std::uint64_t> codes) {
  sort_unique(codes);
  Rebuild result{.bricks = codes.size()};
  const OccupancyOptions& options = map_.options();
  LogOddsMap fresh;
  std::vector<Touched> batch;
  for (std::size_t first = 0; first < scans_.size(); first += kBatch) {
    batch.assign(std::min(kBatch, scans_.size() - first), {});
    const auto open = [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        batch[i] = bricks_among(scans_[first + i].cells, codes);
      }
    };
    parallel_for(batch.size(), open, {.num_threads = options.num_threads, .chunk = 1});
    for (const Touched& scan : batch) {
      fresh.apply(scan.bricks, options.model(), options.num_threads);
      result.blocks += scan.blocks;
    }
  }
  for (const std::uint64_t code : codes) {
    LogOddsBrick& brick = fresh.find_or_add(code);
    if (brick.empty()) {
      map_.bricks().erase(code);
    } else {
      map_.bricks().find_or_add(code) = std::move(brick);
    }
  }
  return result;
}

std::size_t ScanMap::skipped_points() const {
  std::size_t skipped = 0;
  for (const KeptScan& scan : scans_) skipped += scan.cells.skipped;
  return skipped;
}

std::size_t ScanMap::scan_memory() const {
  std::size_t bytes = 0;
  for (const KeptScan& scan : scans_) {
    bytes += sizeof scan + scan.record.name.capacity() + scan.cells.memory_usage();
    for (const PackedColors& block : scan.colors) bytes += sizeof block + block.bytes.capacity();
  }
  return bytes;
}

}  // namespace facula
