// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/parallel.hpp>
#include <facula/map/dense_cast.hpp>
#include <facula/map/dense_cells.hpp>
#include <facula/map/ray_walk.hpp>

#include <algorithm>
#include <atomic>
#include <limits>
#include <mutex>

namespace facula {
namespace {

/// Largest box: 32 MB per set of cells and thread.
constexpr double kMaxCells = 268435456.0;
/// A box that rays hardly fill costs more to clear and to read than to do without.
constexpr double kMaxCellsPerRay = 8192.0;
constexpr std::size_t kRaysPerChunk = 4096;

struct Extent {
  Eigen::Vector3d low = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Vector3d high = -low;

  void add(const CellKey& key) {
    const Eigen::Vector3d x(key[0], key[1], key[2]);
    low = low.cwiseMin(x);
    high = high.cwiseMax(x);
  }
};

Extent joined(const Extent& a, const Extent& b) {
  Extent both;
  both.low = a.low.cwiseMin(b.low);
  both.high = a.high.cwiseMax(b.high);
  return both;
}

/// Around the first and last cells of all rays that will be walked.
Extent extent_of(const Rays& rays, const CastOptions& options) {
  const auto measure = [&](std::size_t begin, std::size_t end) {
    Extent extent;
    for (std::size_t i = begin; i < end; ++i) {
      const CellRay ray =
          make_ray(rays.origins[i], rays.points[i], options.resolution, options.max_range);
      if (!ray.first || !ray.last) continue;
      extent.add(*ray.first);
      extent.add(*ray.last);
    }
    return extent;
  };
  return parallel_reduce(rays.size(),
                         Extent(),
                         measure,
                         joined,
                         {.num_threads = options.num_threads, .chunk = kRaysPerChunk});
}

/// The box with at least a brick to spare on every side, of whole bricks.
DenseBits box_around(const Extent& extent) {
  DenseBits box;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto axis = static_cast<Eigen::Index>(i);
    const auto low = static_cast<std::int64_t>(extent.low[axis]) / kBrickEdge - 1;
    const auto high = static_cast<std::int64_t>(extent.high[axis]) / kBrickEdge + 1;
    box.corner[i] = low * kBrickEdge;
    box.size[i] = (high - low + 1) * kBrickEdge;
  }
  return box;
}

double cells_in(const DenseBits& box) {
  return static_cast<double>(box.size[0]) * static_cast<double>(box.size[1]) *
         static_cast<double>(box.size[2]);
}

/// One set of cells per thread; which thread walks which rays does not matter to their union.
std::vector<DenseCast> walk_all(const Rays& rays, const CastOptions& options, DenseBits box) {
  const std::size_t chunks = (rays.size() + kRaysPerChunk - 1) / kRaysPerChunk;
  const auto threads =
      std::min(chunks, static_cast<std::size_t>(thread_count(options.num_threads)));
  std::vector<DenseCast> casts(std::max<std::size_t>(1, threads));
  std::atomic<std::size_t> next{0};
  const auto work = [&](std::size_t thread, std::size_t) {
    DenseCast& cast = casts[thread];
    cast.resolution = options.resolution;
    cast.max_range = options.max_range;
    cast.passed = box;
    cast.ended = box;
    cast.passed.clear();
    cast.ended.clear();
    for (std::size_t chunk = next++; chunk < chunks; chunk = next++) {
      cast.walk({rays.origins.front().data(),
                 rays.points.front().data(),
                 chunk * kRaysPerChunk,
                 std::min(rays.size(), (chunk + 1) * kRaysPerChunk)});
    }
  };
  parallel_for(casts.size(), work, {.num_threads = static_cast<int>(casts.size()), .chunk = 1});
  return casts;
}

/// The union of one brick of all casts.
ScanBrick brick_at(const std::vector<DenseCast>& casts, const std::array<std::int64_t, 3>& first) {
  ScanBrick brick;
  for (const DenseCast& cast : casts) {
    for (std::size_t z = 0; z < 8; ++z) {
      for (std::size_t y = 0; y < 8; ++y) {
        const auto row = first[1] + static_cast<std::int64_t>(y);
        const auto layer = first[2] + static_cast<std::int64_t>(z);
        brick.passed.words[z] |= std::uint64_t{cast.passed.byte(first[0], row, layer)} << 8 * y;
        brick.ended.words[z] |= std::uint64_t{cast.ended.byte(first[0], row, layer)} << 8 * y;
      }
    }
  }
  brick.passed &= ~brick.ended;
  return brick;
}

/// All bricks that hold a cell, in ascending order of their codes.
std::vector<ScanBrick> bricks_of(const std::vector<DenseCast>& casts, int num_threads) {
  const DenseBits& box = casts.front().passed;
  const auto in_grid = [](std::int64_t key) { return key >= 0 && key < kKeyLimit; };
  std::vector<ScanBrick> bricks;
  std::mutex joining;
  const auto read_layers = [&](std::size_t begin, std::size_t end) {
    std::vector<ScanBrick> found;
    for (std::size_t layer = begin; layer < end; ++layer) {
      const auto z = static_cast<std::int64_t>(layer) * kBrickEdge;
      for (std::int64_t y = 0; y < box.size[1]; y += kBrickEdge) {
        for (std::int64_t x = 0; x < box.size[0]; x += kBrickEdge) {
          ScanBrick brick = brick_at(casts, {x, y, z});
          if ((brick.passed | brick.ended).none()) continue;
          const std::array<std::int64_t, 3> key = {
              box.corner[0] + x, box.corner[1] + y, box.corner[2] + z};
          if (!in_grid(key[0]) || !in_grid(key[1]) || !in_grid(key[2])) continue;
          brick.code = brick_code(
              {static_cast<int>(key[0]), static_cast<int>(key[1]), static_cast<int>(key[2])});
          found.push_back(brick);
        }
      }
    }
    const std::scoped_lock lock(joining);
    bricks.insert(bricks.end(), found.begin(), found.end());
  };
  parallel_for(static_cast<std::size_t>(box.size[2] / kBrickEdge),
               read_layers,
               {.num_threads = num_threads, .chunk = 1});
  std::sort(bricks.begin(), bricks.end(), [](const ScanBrick& a, const ScanBrick& b) {
    return a.code < b.code;
  });
  return bricks;
}

}  // namespace

std::optional<ScanCells> dense_cells(const Rays& rays, const CastOptions& options) {
  const Extent extent = extent_of(rays, options);
  if (!extent.low.allFinite()) return std::nullopt;
  const DenseBits box = box_around(extent);
  if (cells_in(box) > std::min(kMaxCells, kMaxCellsPerRay * static_cast<double>(rays.size()))) {
    return std::nullopt;
  }
  const std::vector<DenseCast> casts = walk_all(rays, options, box);
  ScanCells result;
  for (const DenseCast& cast : casts) result.skipped += cast.skipped;
  result.bricks = bricks_of(casts, options.num_threads);
  return result;
}

}  // namespace facula
