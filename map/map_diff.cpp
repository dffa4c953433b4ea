// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/map/cell_clusters.hpp>
#include <facula/map/map_diff.hpp>
#include <facula/map/map_merge.hpp>

#include <algorithm>
#include <array>
#include <numeric>

namespace facula {
namespace {

constexpr int kMostSlack = 10;
constexpr std::size_t kKinds = 3;

/// Changed cells of one kind, in the order of the octree.
using CellsByKind = std::array<std::vector<CellKey>, kKinds>;

bool has_occupied_near(const OccupancyMap& map, const CellKey& cell, int reach) {
  for (int z = -reach; z <= reach; ++z) {
    for (int y = -reach; y <= reach; ++y) {
      for (int x = -reach; x <= reach; ++x) {
        const CellKey near = {cell[0] + x, cell[1] + y, cell[2] + z};
        const bool inside = std::all_of(
            near.begin(), near.end(), [](int key) { return key >= 0 && key < kKeyLimit; });
        if (inside && map.state_of_cell(near) == CellState::kOccupied) return true;
      }
    }
  }
  return false;
}

/// The second map in the first's cells; what it says is kept, whatever the clamps.
OccupancyMap seen_in(const OccupancyMap& before,
                     const OccupancyMap& after,
                     const RigidTransform& before_from_after,
                     int num_threads) {
  OccupancyMap here({.resolution = before.resolution(), .num_threads = num_threads});
  merge_map(here, after, before_from_after);
  return here;
}

CellsByKind changed_cells(const OccupancyMap& before,
                          const OccupancyMap& after,
                          const MapDiffOptions& options,
                          MapDiff& diff) {
  CellsByKind cells;
  after.for_each_brick([&](const OccupancyMap::BrickView& now) {
    const LogOddsBrick* brick = before.bricks().find(brick_code(now.first));
    const CellMask known = brick == nullptr ? CellMask() : brick->known();
    const CellMask occupied = brick == nullptr ? CellMask() : brick->occupied();
    diff.compared_cells += static_cast<std::size_t>((known & now.known).count());
    const auto collect = [&](ChangeKind kind, const CellMask& changed, const OccupancyMap& other) {
      for_each_cell(changed, [&](std::size_t place) {
        const CellKey cell = cell_at(now.first, place);
        if (options.slack_cells > 0 && has_occupied_near(other, cell, options.slack_cells)) return;
        cells[static_cast<std::size_t>(kind)].push_back(cell);
      });
    };
    collect(ChangeKind::kAppeared, known & ~occupied & now.occupied, before);
    collect(ChangeKind::kVanished, occupied & now.known & ~now.occupied, after);
    if (options.newly_seen) collect(ChangeKind::kNewlySeen, ~known & now.occupied, before);
  });
  return cells;
}

/// A cluster and its cells.
struct Group {
  ChangeCluster cluster;
  std::vector<CellKey> cells;
};

ChangeCluster cluster_of(ChangeKind kind, const std::vector<CellKey>& cells, double resolution) {
  ChangeCluster cluster{.kind = kind, .cells = cells.size()};
  Eigen::AlignedBox3d box;
  for (const CellKey& cell : cells) {
    const Eigen::Vector3d centre = centre_of(cell, resolution);
    cluster.centre += centre / static_cast<double>(cells.size());
    box.extend(centre);
  }
  cluster.volume = static_cast<double>(cells.size()) * resolution * resolution * resolution;
  cluster.min = box.min().array() - resolution / 2;
  cluster.max = box.max().array() + resolution / 2;
  return cluster;
}

std::vector<Group> groups_of(const CellsByKind& cells, double resolution) {
  std::vector<Group> groups;
  for (std::size_t kind = 0; kind < kKinds; ++kind) {
    const std::size_t first = groups.size();
    const std::vector<std::size_t> numbers = cell_clusters(cells[kind]);
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      groups.resize(std::max(groups.size(), first + numbers[i] + 1));
      groups[first + numbers[i]].cells.push_back(cells[kind][i]);
    }
    for (std::size_t i = first; i < groups.size(); ++i) {
      groups[i].cluster = cluster_of(static_cast<ChangeKind>(kind), groups[i].cells, resolution);
    }
  }
  std::stable_sort(groups.begin(), groups.end(), [](const Group& a, const Group& b) {
    return a.cells.size() > b.cells.size();
  });
  return groups;
}

}  // namespace

void MapDiffOptions::check() const {
  require(slack_cells >= 0 && slack_cells <= kMostSlack,
          "MapDiffOptions: expected slack_cells of 0 to ",
          kMostSlack,
          ", got ",
          slack_cells);
}

std::string to_string(ChangeKind kind) {
  switch (kind) {
    case ChangeKind::kAppeared:
      return "appeared";
    case ChangeKind::kVanished:
      return "vanished";
    case ChangeKind::kNewlySeen:
      return "newly seen";
  }
  return "changed";
}

MapDiff diff_maps(const OccupancyMap& before,
                  const OccupancyMap& after,
                  const RigidTransform& before_from_after,
                  const MapDiffOptions& options) {
  options.check();
  MapDiff diff{.resolution = before.resolution(), .clusters = {}, .cells = {}};
  const OccupancyMap here = seen_in(before, after, before_from_after, options.num_threads);
  const CellsByKind changed = changed_cells(before, here, options, diff);
  for (const Group& group : groups_of(changed, diff.resolution)) {
    if (group.cells.size() < options.min_cells) {
      diff.left_out_cells += group.cells.size();
      continue;
    }
    for (const CellKey& cell : group.cells) diff.cells.push_back({cell, diff.clusters.size()});
    diff.clusters.push_back(group.cluster);
  }
  return diff;
}

PointCloud cloud_of_changes(const MapDiff& diff) {
  static constexpr std::array<Color, kKinds> kColors = {
      Color{40, 180, 60}, Color{220, 40, 40}, Color{60, 90, 220}};
  PointCloud cloud;
  for (const ChangedCell& cell : diff.cells) {
    cloud.points.emplace_back(centre_of(cell.key, diff.resolution).cast<float>());
    cloud.colors.push_back(kColors[static_cast<std::size_t>(diff.clusters[cell.cluster].kind)]);
  }
  return cloud;
}

}  // namespace facula
