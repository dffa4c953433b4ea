// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/parallel.hpp>
#include <facula/apps/cli/number_text.hpp>
#include <facula/apps/commands/demo/map_error.hpp>

#include <cmath>
#include <cstdint>
#include <vector>

namespace facula {
namespace {

struct FinestCell {
  Eigen::Vector3d center;
  bool occupied = false;
};

/// Leaves larger than a cell stand for all the cells in them.
std::vector<FinestCell> finest_cells(const OccupancyMap& map) {
  const double edge = map.resolution();
  std::vector<FinestCell> cells;
  map.for_each_leaf([&](const Eigen::Vector3d& center, CellState state, double size) {
    if (state == CellState::kUnknown) return;
    const int per_side = static_cast<int>(std::lround(size / edge));
    const Eigen::Vector3d first = center.array() - (size - edge) / 2;
    for (int x = 0; x < per_side; ++x) {
      for (int y = 0; y < per_side; ++y) {
        for (int z = 0; z < per_side; ++z) {
          cells.push_back({first + edge * Eigen::Vector3d(x, y, z), state == CellState::kOccupied});
        }
      }
    }
  });
  return cells;
}

bool is_wrong(const FinestCell& cell, const Scene& scene, double edge, double tolerance) {
  if (!cell.occupied) return scene.inside(cell.center) && scene.distance(cell.center) > edge;
  return scene.distance(cell.center) > std::sqrt(3.0) / 2 * edge + tolerance;
}

}  // namespace

void report_map_errors(const OccupancyMap& map,
                       const Scene& scene,
                       double tolerance,
                       int num_threads,
                       Figures& figures) {
  const std::vector<FinestCell> cells = finest_cells(map);
  std::vector<std::uint8_t> wrong(cells.size());
  parallel_for(cells.size(),
               [&](std::size_t begin, std::size_t end) {
                 for (std::size_t i = begin; i < end; ++i) {
                   wrong[i] = is_wrong(cells[i], scene, map.resolution(), tolerance) ? 1 : 0;
                 }
               },
               {num_threads, 4096});
  std::size_t count[2] = {0, 0};
  std::size_t bad[2] = {0, 0};
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const int kind = cells[i].occupied ? 1 : 0;
    ++count[kind];
    bad[kind] += wrong[i];
  }
  const auto percent = [&](int kind) {
    return count[kind] == 0
               ? 0.0
               : 100.0 * static_cast<double>(bad[kind]) / static_cast<double>(count[kind]);
  };
  figures.count("wrong_occupied_cells", "wrongly occupied cells", bad[1]);
  figures.number("wrong_occupied_percent", "wrongly occupied", percent(1), 4);
  figures.count("wrong_free_cells", "wrongly free cells", bad[0]);
  figures.number("wrong_free_percent", "wrongly free", percent(0), 4);
  figures.number("occupied_tolerance_mm", "tolerance", 1000 * tolerance, 2);
  figures.note(
      "  An occupied cell is wrong when its centre is farther from every surface than half "
      "its diagonal plus the tolerance\n  (2 sigma of a point); a free cell when its "
      "centre is inside matter, deeper than an edge of a cell.");
}

}  // namespace facula
