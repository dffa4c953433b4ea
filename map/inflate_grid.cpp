// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/map/navigation_grid.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace facula {
namespace {

constexpr int kFar = std::numeric_limits<int>::max() / 2;

/// For every cell, how many rows up or down the nearest occupied cell of its column is.
std::vector<int> rows_to_occupied(const NavigationGrid& grid) {
  const auto cols = static_cast<std::size_t>(grid.cols);
  std::vector<int> rows(grid.size(), kFar);
  for (std::size_t i = 0; i < grid.size(); ++i) {
    if (grid.cells[i] == NavigationGrid::kOccupied)
      rows[i] = 0;
    else if (i >= cols)
      rows[i] = std::min(kFar, rows[i - cols] + 1);
  }
  for (std::size_t i = grid.size() - cols; i-- > 0;) {
    rows[i] = std::min(rows[i], rows[i + cols] + 1);
  }
  return rows;
}

/// Half the width of a disc of `radius` [cells], `rows` away from its middle; -1 outside.
int half_width(double radius, int rows) {
  if (rows > radius) return -1;
  // A neighbour exactly at the radius belongs to the disc, whatever the rounding.
  return static_cast<int>(std::sqrt(radius * radius - static_cast<double>(rows) * rows) + 1e-9);
}

/// The cells that any of the row's intervals [i - reach, i + reach] takes in.
std::vector<bool> covered_in_row(std::span<const int> reach) {
  const int cols = static_cast<int>(reach.size());
  std::vector<bool> covered(reach.size(), false);
  int right = -1;  // how far the intervals met so far reach
  for (int col = 0; col < cols; ++col) {
    const auto i = static_cast<std::size_t>(col);
    if (reach[i] >= 0) right = std::max(right, col + reach[i]);
    if (col <= right) covered[i] = true;
  }
  int left = cols;
  for (int col = cols - 1; col >= 0; --col) {
    const auto i = static_cast<std::size_t>(col);
    if (reach[i] >= 0) left = std::min(left, col - reach[i]);
    if (col >= left) covered[i] = true;
  }
  return covered;
}

}  // namespace

void inflate(NavigationGrid& grid, double radius) {
  require(std::isfinite(radius) && radius >= 0,
          "expected a radius of 0 m or more to inflate a grid by, got ",
          radius);
  if (radius == 0 || grid.cells.empty()) return;
  // Beyond the grid's own size a radius changes nothing.
  const double cells = std::min(radius / grid.resolution + 1e-9, grid.rows + 1.0 + grid.cols);
  const std::vector<int> rows = rows_to_occupied(grid);
  std::vector<int> reach(grid.size());
  std::transform(
      rows.begin(), rows.end(), reach.begin(), [&](int r) { return half_width(cells, r); });
  for (int row = 0; row < grid.rows; ++row) {
    const std::size_t begin = static_cast<std::size_t>(row) * static_cast<std::size_t>(grid.cols);
    const std::vector<bool> covered =
        covered_in_row(std::span(reach).subspan(begin, static_cast<std::size_t>(grid.cols)));
    for (std::size_t col = 0; col < covered.size(); ++col) {
      if (!covered[col]) continue;
      grid.cells[begin + col] = NavigationGrid::kOccupied;
      if (!grid.occupancy.empty()) grid.occupancy[begin + col] = 100;
    }
  }
}

}  // namespace facula
