// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/map/navigation_grid.hpp>

#include <cmath>
#include <limits>

namespace facula {
namespace {

/// Largest grid that is made [cells]: 32768 x 32768. One stray point far out could ask for more.
constexpr double kMaxCells = 1073741824.0;

bool in_band(const NavigationGridOptions& options, double z, double edge) {
  // A shared face is not an overlap; cell faces come from doubles that may be off by a rounding.
  const double slack = 1e-6 * edge;
  return z + edge / 2 > options.min_height + slack && z - edge / 2 < options.max_height - slack;
}

/// An empty grid around all known cells of the band.
NavigationGrid empty_grid(const OccupancyMap& map, const NavigationGridOptions& options) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Eigen::Vector2d min = Eigen::Vector2d::Constant(kInfinity);
  Eigen::Vector2d max = -min;
  map.for_each_leaf([&](const Eigen::Vector3d& centre, CellState, double edge) {
    if (!in_band(options, centre.z(), edge)) return;
    min = min.cwiseMin((centre.head<2>().array() - edge / 2).matrix());
    max = max.cwiseMax((centre.head<2>().array() + edge / 2).matrix());
  });
  require(min.allFinite(),
          "the map has no known cell between the heights ",
          options.min_height,
          " m and ",
          options.max_height,
          " m; choose heights that the scans have seen");
  const Eigen::Vector2d cells = (max - min) / map.resolution();
  require(cells.prod() <= kMaxCells,
          "a grid of ",
          cells.x(),
          " x ",
          cells.y(),
          " cells is too large; use coarser cells or a shorter range");
  NavigationGrid grid;
  grid.cols = static_cast<int>(std::lround(cells.x()));
  grid.rows = static_cast<int>(std::lround(cells.y()));
  grid.resolution = map.resolution();
  grid.origin = min;
  grid.cells.assign(static_cast<std::size_t>(grid.rows) * static_cast<std::size_t>(grid.cols),
                    NavigationGrid::kUnknown);
  return grid;
}

/// Writes a leaf's square; occupied stays occupied whatever lies above or below.
void paint(NavigationGrid& grid, const Eigen::Vector3d& centre, CellState state, double edge) {
  const auto index = [&](double corner, double origin) {
    return std::lround((corner - origin) / grid.resolution);
  };
  const long width = std::lround(edge / grid.resolution);
  const long first_col = index(centre.x() - edge / 2, grid.origin.x());
  const long first_up = index(centre.y() - edge / 2, grid.origin.y());
  for (long up = first_up; up < first_up + width; ++up) {
    const auto row = static_cast<std::size_t>(grid.rows - 1 - up);
    for (long col = first_col; col < first_col + width; ++col) {
      std::uint8_t& cell =
          grid.cells[row * static_cast<std::size_t>(grid.cols) + static_cast<std::size_t>(col)];
      if (state == CellState::kOccupied)
        cell = NavigationGrid::kOccupied;
      else if (cell == NavigationGrid::kUnknown)
        cell = NavigationGrid::kFree;
    }
  }
}

}  // namespace

void NavigationGridOptions::check() const {
  require(std::isfinite(min_height) && std::isfinite(max_height) && max_height > min_height,
          "NavigationGridOptions: expected max_height above min_height, got ",
          min_height,
          " m to ",
          max_height,
          " m");
}

NavigationGrid navigation_grid(const OccupancyMap& map, const NavigationGridOptions& options) {
  options.check();
  NavigationGrid grid = empty_grid(map, options);
  map.for_each_leaf([&](const Eigen::Vector3d& centre, CellState state, double edge) {
    if (in_band(options, centre.z(), edge)) paint(grid, centre, state, edge);
  });
  return grid;
}

}  // namespace facula
