// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/apps/cli/arguments.hpp>
#include <facula/apps/commands/map_figures.hpp>

#include <algorithm>
#include <cstddef>
#include <utility>

namespace facula {

void report_map(const OccupancyMap& map, Figures& figures) {
  const MapStatistics statistics = map.statistics();
  const Eigen::Vector3d& low = statistics.min;
  const Eigen::Vector3d& high = statistics.max;
  figures.number("resolution_mm", "cell", 1000 * map.resolution(), 1);
  figures.count("free_cells", "free cells", statistics.free_cells);
  figures.count("occupied_cells", "occupied cells", statistics.occupied_cells);
  if (!map.colors().empty()) {
    std::size_t colored = 0;
    for (const ColorBrick& brick : map.colors().bricks()) colored += brick.sums.size();
    figures.count("colored_cells", "coloured cells", colored);
  }
  figures.count("nodes", "nodes of the tree", statistics.nodes);
  figures.count("memory", "memory, bytes", statistics.memory);
  figures.numbers("min_m", "lower corner", {low.x(), low.y(), low.z()}, 3);
  figures.numbers("max_m", "upper corner", {high.x(), high.y(), high.z()}, 3);
}

void report_map_file(const MapFile& file, Figures& figures) {
  report_map(file.map, figures);
  const OccupancyOptions& options = file.map.options();
  figures.numbers("sensor_model",
                  "probabilities hit, miss, clamps",
                  {options.hit, options.miss, options.clamp_min, options.clamp_max},
                  4);
  figures.number("max_range_m", "maximum range (0 = none)", options.max_range, 3);
  figures.count("kept_scans", "scans kept", file.scans.size());
  if (file.scans.empty()) return;
  FigureTable table{"scans",
                    "Scans:",
                    {{"name", "name", 0},
                     {"points", "points", 0},
                     {"x_m", "x", 3},
                     {"y_m", "y", 3},
                     {"z_m", "z", 3},
                     {"rotation_deg", "turned by", 3},
                     {"cells_kb", "cells kept", 1}},
                    {}};
  for (const KeptScan& scan : file.scans) {
    const RigidTransform& pose = scan.record.world_from_scan;
    table.rows.push_back({scan.record.name,
                          static_cast<long long>(scan.record.points),
                          pose.translation.x(),
                          pose.translation.y(),
                          pose.translation.z(),
                          rotation_angle(pose) / kDegrees.factor,
                          static_cast<double>(scan.cells.memory_usage()) / 1e3});
  }
  figures.table(std::move(table));
}

void report_grid(const NavigationGrid& grid, Figures& figures) {
  const auto cells_of = [&](std::uint8_t state) {
    return static_cast<std::size_t>(std::count(grid.cells.begin(), grid.cells.end(), state));
  };
  figures.count("grid_cols", "columns", static_cast<std::size_t>(grid.cols));
  figures.count("grid_rows", "rows", static_cast<std::size_t>(grid.rows));
  figures.number("grid_resolution_mm", "cell", 1000 * grid.resolution, 1);
  figures.numbers("grid_origin_m", "lower left corner", {grid.origin.x(), grid.origin.y()}, 3);
  figures.count("grid_free_cells", "free cells", cells_of(NavigationGrid::kFree));
  figures.count("grid_occupied_cells", "occupied cells", cells_of(NavigationGrid::kOccupied));
  figures.count("grid_unknown_cells", "unknown cells", cells_of(NavigationGrid::kUnknown));
}

}  // namespace facula
