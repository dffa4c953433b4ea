// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/map/navigation_grid.hpp>
#include <facula/map/standpoints.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace facula {
namespace {

/// Places that are free themselves, whether they hang together or not; no lattice yet.
StandArea free_area(const OccupancyMap& map, const Floor& floor, const StandpointOptions& options) {
  StandArea area;
  area.height = floor.height + options.scanner_height;
  const double above = std::max(area.height, floor.top + map.resolution());
  const NavigationGrid grid = navigation_grid(
      map, {.min_height = floor.top, .max_height = above, .inflation = options.clearance});
  area.rows = grid.rows;
  area.cols = grid.cols;
  area.resolution = grid.resolution;
  area.origin = grid.origin;
  for (std::size_t cell = 0; cell < grid.size(); ++cell) {
    area.inside.push_back(grid.cells[cell] == NavigationGrid::kFree &&
                          map.state(area.position(cell)) == CellState::kFree);
  }
  return area;
}

/// The cells of the largest area of marked cells that touch by a side, in ascending order; of equal
/// ones the first.
std::vector<std::size_t> largest_area(std::size_t cols, std::vector<bool> marked) {
  std::vector<std::size_t> largest;
  for (std::size_t start = 0; start < marked.size(); ++start) {
    if (!marked[start]) continue;
    std::vector<std::size_t> area;
    const auto take = [&](std::size_t cell) {
      if (!marked[cell]) return;
      marked[cell] = false;
      area.push_back(cell);
    };
    take(start);
    std::size_t next = 0;
    while (next < area.size()) {  // take() adds to it
      const std::size_t cell = area[next++];
      if (cell % cols != 0) take(cell - 1);
      if (cell % cols + 1 != cols) take(cell + 1);
      if (cell >= cols) take(cell - cols);
      if (cell + cols < marked.size()) take(cell + cols);
    }
    if (area.size() > largest.size()) largest = std::move(area);
  }
  std::sort(largest.begin(), largest.end());
  return largest;
}

/// Every stride-th cell of every stride-th row.
std::vector<std::size_t> thinned(const std::vector<std::size_t>& cells,
                                 std::size_t cols,
                                 int stride) {
  const auto step = static_cast<std::size_t>(stride);
  std::vector<std::size_t> kept;
  for (const std::size_t cell : cells) {
    if (cell % cols % step == 0 && cell / cols % step == 0) kept.push_back(cell);
  }
  return kept;
}

}  // namespace

void StandpointOptions::check() const {
  require(std::isfinite(scanner_height) && scanner_height > 0,
          "StandpointOptions: expected scanner_height above 0 m, got ",
          scanner_height);
  require(std::isfinite(clearance) && clearance >= 0,
          "StandpointOptions: expected clearance of 0 m or more, got ",
          clearance);
  require(std::isfinite(spacing) && spacing > 0,
          "StandpointOptions: expected spacing above 0 m, got ",
          spacing);
  require(most >= 1, "StandpointOptions: expected at least 1 standpoint, got 0");
}

Eigen::Vector3d StandArea::position(std::size_t cell) const {
  const auto width = static_cast<std::size_t>(cols);
  const auto x = static_cast<double>(cell % width);
  const std::size_t row = cell / width;
  const double y = rows - 1 - static_cast<double>(row);
  return {origin.x() + (x + 0.5) * resolution, origin.y() + (y + 0.5) * resolution, height};
}

std::vector<std::size_t> StandArea::around(std::size_t cell, int step) const {
  const int row = static_cast<int>(cell) / cols;
  const int col = static_cast<int>(cell) % cols;
  std::vector<std::size_t> places;
  for (const int down : {-step, 0, step}) {
    for (const int right : {-step, 0, step}) {
      const int r = row + down;
      const int c = col + right;
      if ((down == 0 && right == 0) || r < 0 || r >= rows || c < 0 || c >= cols) continue;
      const auto place = static_cast<std::size_t>(r) * static_cast<std::size_t>(cols) +
                         static_cast<std::size_t>(c);
      if (inside[place]) places.push_back(place);
    }
  }
  return places;
}

StandArea find_standpoints(const OccupancyMap& map,
                           const Floor& floor,
                           const StandpointOptions& options) {
  options.check();
  StandArea area = free_area(map, floor, options);
  const auto cols = static_cast<std::size_t>(area.cols);
  const std::vector<std::size_t> cells = largest_area(cols, std::move(area.inside));
  require(!cells.empty(),
          "no place for a tripod is free at ",
          options.scanner_height,
          " m above the floor (z = ",
          floor.height,
          " m) and ",
          options.clearance,
          " m around; give another height of the scanner or of the floor");
  area.inside.assign(static_cast<std::size_t>(area.rows) * cols, false);
  for (const std::size_t cell : cells) area.inside[cell] = true;
  area.stride = static_cast<int>(std::clamp(options.spacing / area.resolution, 1.0, 65536.0));
  area.lattice = thinned(cells, cols, area.stride);
  while (area.lattice.size() > options.most) area.lattice = thinned(cells, cols, ++area.stride);
  if (area.lattice.empty()) area.lattice.push_back(cells[cells.size() / 2]);
  return area;
}

}  // namespace facula
