// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/atomic_file.hpp>
#include <facula/acquire/core/error.hpp>
#include <facula/map/cell_box.hpp>
#include <facula/map/map_file.hpp>
#include <facula/map/map_folder.hpp>
#include <facula/map/occupancy_map.hpp>
#include <facula/map/octree_file.hpp>
#include <facula/map/pruned_octree.hpp>

#include <utility>

namespace facula {
namespace {

CellState state_of(std::optional<float> log_odds) {
  if (!log_odds) return CellState::kUnknown;
  return is_occupied(*log_odds) ? CellState::kOccupied : CellState::kFree;
}

}  // namespace

OccupancyMap::OccupancyMap(const OccupancyOptions& options) : options_(options) {
  options.check();
}

void OccupancyMap::insert(const PointCloud& cloud) {
  insert(cells_of_scan(cloud, options_.cast()));
  if (!cloud.colors.empty()) colors_.add(colors_of_scan(cloud, options_.cast()));
}

void OccupancyMap::insert(const ScanCells& scan) {
  skipped_ += scan.skipped;
  bricks_.apply(scan.bricks, options_.model(), options_.num_threads);
}

std::optional<float> OccupancyMap::log_odds(const Eigen::Vector3d& x) const {
  const auto cell = cell_of(x, options_.resolution);
  if (!cell) return std::nullopt;
  const LogOddsBrick* brick = bricks_.find(brick_code(*cell));
  return brick == nullptr ? std::nullopt : brick->value(cell_in_brick(*cell));
}

CellState OccupancyMap::state(const Eigen::Vector3d& x) const {
  return state_of(log_odds(x));
}

CellState OccupancyMap::state_of_cell(const CellKey& cell) const {
  const LogOddsBrick* brick = bricks_.find(brick_code(cell));
  return brick == nullptr ? CellState::kUnknown : state_of(brick->value(cell_in_brick(cell)));
}

MapStatistics OccupancyMap::statistics() const {
  MapStatistics statistics;
  for_each_brick([&](const BrickView& brick) {
    const auto occupied = static_cast<std::size_t>(brick.occupied.count());
    statistics.occupied_cells += occupied;
    statistics.free_cells += static_cast<std::size_t>(brick.known.count()) - occupied;
  });
  statistics.nodes = PrunedOctree(bricks_).size();
  statistics.memory = bricks_.memory_usage() + colors_.memory_usage();
  const std::optional<CellBox> box = known_box(*this);
  if (!box) return statistics;
  const CellKey behind = {box->high[0] + 1, box->high[1] + 1, box->high[2] + 1};
  const Eigen::Vector3d half = Eigen::Vector3d::Constant(options_.resolution / 2);
  statistics.min = centre_of(box->low, options_.resolution) - half;
  statistics.max = centre_of(behind, options_.resolution) - half;
  return statistics;
}

void OccupancyMap::for_each_leaf(
    const std::function<void(const Eigen::Vector3d&, CellState, double)>& visit) const {
  PrunedOctree(bricks_).for_each_node([&](const OctreeNode& node) {
    if (node.children != 0) return;
    const double edge = options_.resolution * (1 << node.level);
    const Eigen::Vector3d low =
        centre_of(node.first, options_.resolution).array() - options_.resolution / 2;
    visit((low.array() + edge / 2).matrix(), state_of(node.value), edge);
  });
}

void OccupancyMap::for_each_brick(const std::function<void(const BrickView&)>& visit) const {
  for (const LogOddsMap::Entry* entry : bricks_.sorted()) {
    visit({first_cell(entry->code), entry->brick.known(), entry->brick.occupied()});
  }
}

void OccupancyMap::write(const std::filesystem::path& path) const {
  const std::string extension = path.extension().string();
  if (extension == ".fmap") return write_map_file(path, *this);
  require(extension == ".ot" || extension == ".bt",
          "cannot write the map '",
          path.string(),
          "': expected a name ending in .ot (probabilities), .bt (free or occupied) or .fmap "
          "(everything)");
  AtomicFile file(path);
  std::ostream& stream = file.stream();
  if (extension == ".bt") {
    write_bt(stream, bricks_, options_.resolution);
  } else if (colors_.empty()) {
    write_ot(stream, bricks_, options_.resolution);
  } else {
    write_color_ot(stream, bricks_, colors_, options_.resolution);
  }
  file.commit();
}

OccupancyMap OccupancyMap::read(const std::filesystem::path& path) {
  if (is_map_file(path)) return read_map_file(path).map;
  if (is_block_index(path)) return read_map_folder(path);
  OctreeContent content = read_octree(path, OccupancyOptions().model());
  OccupancyMap map({.resolution = content.resolution});
  map.bricks_ = std::move(content.map);
  map.colors_ = std::move(content.colors);
  return map;
}

}  // namespace facula
