// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/parallel.hpp>
#include <facula/map/bulk_update.hpp>
#include <facula/map/occupancy_map.hpp>
#include <facula/map/octree_file.hpp>
#include <facula/map/ray_walk.hpp>

#include <cmath>
#include <mutex>
#include <utility>

#include <octomap/OcTree.h>

namespace facula {
namespace {

/// Rays per piece of work: enough that joining the pieces costs little.
constexpr std::size_t kRaysPerChunk = 32768;

void require_between(const char* field, double value, std::pair<double, double> bounds) {
  require(value > bounds.first && value < bounds.second,
          "OccupancyOptions: expected ",
          field,
          " between ",
          bounds.first,
          " and ",
          bounds.second,
          ", got ",
          value);
}

struct ScanCells {
  std::vector<VoxelBrick> bricks;
  std::size_t skipped = 0;
};

/// The cells that the rays of a cloud meet: a union, so neither order nor threads matter.
ScanCells cells_of(const PointCloud& cloud, const VoxelGrid& grid, int num_threads) {
  VoxelBricks all;
  ScanCells result;
  std::mutex joining;
  const auto walk_chunk = [&](std::size_t begin, std::size_t end) {
    VoxelBricks cells;
    std::size_t skipped = 0;
    for (std::size_t i = begin; i < end; ++i) {
      if (!walk_ray(grid, cloud.sensor_origin[i], cloud.points[i], cells)) ++skipped;
    }
    const std::scoped_lock lock(joining);
    all.merge(cells);
    result.skipped += skipped;
  };
  parallel_for(cloud.size(), walk_chunk, {.num_threads = num_threads, .chunk = kRaysPerChunk});
  result.bricks = all.take_sorted();
  return result;
}

CellState state_of(const octomap::OcTree& tree, const octomap::OcTreeNode& node) {
  return tree.isNodeOccupied(&node) ? CellState::kOccupied : CellState::kFree;
}

}  // namespace

void OccupancyOptions::check() const {
  require(std::isfinite(resolution) && resolution > 0,
          "OccupancyOptions: expected a resolution above 0 m, got ",
          resolution);
  require(std::isfinite(max_range) && max_range >= 0,
          "OccupancyOptions: expected max_range of 0 m (no limit) or more, got ",
          max_range);
  require_between("hit", hit, {0.5, 1});
  require_between("miss", miss, {0, 0.5});
  require_between("clamp_min", clamp_min, {0, 0.5});
  require_between("clamp_max", clamp_max, {0.5, 1});
}

struct OccupancyMap::Impl {
  explicit Impl(const OccupancyOptions& o) : options(o), tree(o.resolution) {
    tree.setProbHit(o.hit);
    tree.setProbMiss(o.miss);
    tree.setClampingThresMin(o.clamp_min);
    tree.setClampingThresMax(o.clamp_max);
  }

  explicit Impl(const octomap::OcTree& other) : tree(other) {}

  OccupancyOptions options;  // the tree holds the resolution and the sensor model
  octomap::OcTree tree;
  std::size_t skipped = 0;
};

OccupancyMap::OccupancyMap(const OccupancyOptions& options) {
  options.check();
  impl_ = std::make_unique<Impl>(options);
}

OccupancyMap::~OccupancyMap() = default;
OccupancyMap::OccupancyMap(OccupancyMap&&) noexcept = default;
OccupancyMap& OccupancyMap::operator=(OccupancyMap&&) noexcept = default;

void OccupancyMap::insert(const PointCloud& cloud) {
  cloud.check();
  require(cloud.sensor_origin.size() == cloud.size(),
          "a map needs to know where every point was seen from: the cloud has ",
          cloud.size(),
          " points but no sensor origins");
  const VoxelGrid grid{impl_->tree.getResolution(), impl_->options.max_range};
  ScanCells scan = cells_of(cloud, grid, impl_->options.num_threads);
  impl_->skipped += scan.skipped;
  update_cells(impl_->tree, std::move(scan.bricks));
}

std::size_t OccupancyMap::skipped_points() const {
  return impl_->skipped;
}

double OccupancyMap::resolution() const {
  return impl_->tree.getResolution();
}

CellState OccupancyMap::state(const Eigen::Vector3d& x) const {
  // OctoMap's own search prints on points outside the tree.
  const double reach = 32768 * resolution();
  if (!(x.array().abs() < reach).all()) return CellState::kUnknown;
  const octomap::OcTreeNode* node = impl_->tree.search(x.x(), x.y(), x.z());
  return node == nullptr ? CellState::kUnknown : state_of(impl_->tree, *node);
}

MapStatistics OccupancyMap::statistics() const {
  const octomap::OcTree& tree = impl_->tree;
  MapStatistics statistics;
  statistics.nodes = tree.size();
  tree.getMetricMin(statistics.min.x(), statistics.min.y(), statistics.min.z());
  tree.getMetricMax(statistics.max.x(), statistics.max.y(), statistics.max.z());
  for (auto leaf = tree.begin_leafs(), end = tree.end_leafs(); leaf != end; ++leaf) {
    const std::size_t cells = std::size_t{1} << (3 * (tree.getTreeDepth() - leaf.getDepth()));
    const bool free = state_of(tree, *leaf) == CellState::kFree;
    (free ? statistics.free_cells : statistics.occupied_cells) += cells;
  }
  return statistics;
}

void OccupancyMap::for_each_leaf(
    const std::function<void(const Eigen::Vector3d&, CellState, double)>& visit) const {
  const octomap::OcTree& tree = impl_->tree;
  for (auto leaf = tree.begin_leafs(), end = tree.end_leafs(); leaf != end; ++leaf) {
    visit({leaf.getX(), leaf.getY(), leaf.getZ()}, state_of(tree, *leaf), leaf.getSize());
  }
}

void OccupancyMap::write(const std::filesystem::path& path) const {
  write_octree(path, impl_->tree);
}

OccupancyMap OccupancyMap::read(const std::filesystem::path& path) {
  const auto tree = read_octree(path);
  OccupancyMap map({.resolution = tree->getResolution()});
  map.impl_->tree.swapContent(*tree);
  return map;
}

OccupancyMap OccupancyMap::from_octree(const octomap::OcTree& tree) {
  OccupancyMap map;
  map.impl_ = std::make_unique<Impl>(tree);
  return map;
}

const octomap::OcTree& OccupancyMap::octree() const {
  return impl_->tree;
}

}  // namespace facula
