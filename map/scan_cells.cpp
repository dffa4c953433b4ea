// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/parallel.hpp>
#include <facula/map/dense_cells.hpp>
#include <facula/map/discretize.hpp>
#include <facula/map/largest_cell.hpp>
#include <facula/map/ray_walk.hpp>
#include <facula/map/sparse_cells.hpp>
#include <facula/map/weigh_hits.hpp>

#include <algorithm>
#include <mutex>
#include <utility>

namespace facula {
namespace {

/// Rays per piece of work: enough that joining the pieces costs little.
constexpr std::size_t kRaysPerChunk = 32768;

/// The cells of a box, as OctoMap compares them: points by coordinates, cells by keys.
struct KeyBox {
  MapBox box;
  CellKey low;
  CellKey high;

  bool has(const Eigen::Vector3f& x) const {
    return (x.array() >= box.min.array()).all() && (x.array() <= box.max.array()).all();
  }
  bool has(const CellKey& key) const {
    for (std::size_t i = 0; i < 3; ++i) {
      if (key[i] < low[i] || key[i] > high[i]) return false;
    }
    return true;
  }
};

std::optional<KeyBox> key_box(const CastOptions& options) {
  if (!options.box) return std::nullopt;
  const auto low = cell_of(options.box->min.cast<double>(), options.resolution);
  const auto high = cell_of(options.box->max.cast<double>(), options.resolution);
  require(low && high, "the box of a map must lie within 32768 cells of 0");
  return KeyBox{*options.box, *low, *high};
}

/// OctoMap 1.9.7 takes only rays that end in the box and within the range, and clears from the end
/// back towards the scanner until the box is left.
void walk_in_box(const CellRay& ray,
                 double resolution,
                 const KeyBox& box,
                 std::vector<CellKey>& way,
                 SparseCells& cells) {
  if (ray.cut || !box.has(ray.end)) return;
  cells.end(*ray.last);
  way.clear();
  walk_ray(ray, resolution, [&](const CellKey& key) { way.push_back(key); });
  for (auto key = way.rbegin(); key != way.rend() && box.has(*key); ++key) cells.pass(*key);
}

/// Walks the rays of [begin, end); returns how many were skipped.
std::size_t walk_sparse(const Rays& rays,
                        const CastOptions& options,
                        std::pair<std::size_t, std::size_t> range,
                        SparseCells& cells) {
  const auto box = key_box(options);
  std::vector<CellKey> way;
  std::size_t skipped = 0;
  for (std::size_t i = range.first; i < range.second; ++i) {
    const CellRay ray =
        make_ray(rays.origins[i], rays.points[i], options.resolution, options.max_range);
    if (!ray.first || !ray.last) {
      ++skipped;
    } else if (box) {
      walk_in_box(ray, options.resolution, *box, way, cells);
    } else {
      walk_ray(ray, options.resolution, [&](const CellKey& key) { cells.pass(key); });
      if (!ray.cut) cells.end(*ray.last);
    }
  }
  return skipped;
}

ScanCells sparse_cells(const Rays& rays, const CastOptions& options) {
  SparseCells all;
  ScanCells result;
  std::mutex joining;
  const auto walk_chunk = [&](std::size_t begin, std::size_t end) {
    SparseCells cells;
    const std::size_t skipped = walk_sparse(rays, options, {begin, end}, cells);
    const std::scoped_lock lock(joining);
    all.merge(cells);
    result.skipped += skipped;
  };
  parallel_for(
      rays.size(), walk_chunk, {.num_threads = options.num_threads, .chunk = kRaysPerChunk});
  result.bricks = all.take_sorted();
  return result;
}

/// The rays of a cloud, thinned if so asked; `kept` holds what the thinned ones need.
Rays rays_of(const PointCloud& cloud, const CastOptions& options, PointCloud& kept) {
  cloud.check();
  require(cloud.sensor_origin.size() == cloud.size(),
          "a map needs to know where every point was seen from: the cloud has ",
          cloud.size(),
          " points but no sensor origins");
  require(options.resolution > 0 && options.resolution <= kLargestCell,
          "a cell's edge must be above 0 m and at most ",
          kLargestCell,
          " m, got ",
          options.resolution);
  if (!options.discretize) return {cloud.sensor_origin, cloud.points};
  kept = one_ray_per_cell(cloud, options.resolution);
  return {kept.sensor_origin, kept.points};
}

}  // namespace

std::vector<ScanBrick> SparseCells::take_sorted() {
  index_.clear();
  last_ = 0;
  std::vector<ScanBrick> sorted = std::exchange(bricks_, {});
  for (ScanBrick& brick : sorted) brick.passed &= ~brick.ended;
  std::sort(sorted.begin(), sorted.end(), [](const ScanBrick& a, const ScanBrick& b) {
    return a.code < b.code;
  });
  return sorted;
}

ScanCells cells_of_scan(const PointCloud& cloud, const CastOptions& options) {
  PointCloud kept;
  const Rays rays = rays_of(cloud, options, kept);
  std::optional<ScanCells> dense;
  if (!options.box) dense = dense_cells(rays, options);
  ScanCells cells = dense ? *std::move(dense) : sparse_cells(rays, options);
  if (options.weigh_sigma) weigh_hits(cloud, options, cells);
  return cells;
}

ScanCells cells_of_scan_reference(const PointCloud& cloud, const CastOptions& options) {
  PointCloud kept;
  const Rays rays = rays_of(cloud, options, kept);
  SparseCells cells;
  ScanCells result;
  result.skipped = walk_sparse(rays, options, {0, rays.size()}, cells);
  result.bricks = cells.take_sorted();
  if (options.weigh_sigma) weigh_hits(cloud, options, result);
  return result;
}

}  // namespace facula
