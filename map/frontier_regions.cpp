// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/map/frontier_regions.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace facula {
namespace {

using Cells = std::vector<std::size_t>;
constexpr int kWaiting = -2;  // a frontier cell that no region has yet

bool has_unknown_face(const CoarseMap& map, std::size_t index) {
  const std::array<int, 3> cell = map.cell_at(index);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const int step : {-1, 1}) {
      std::array<int, 3> next = cell;
      next[axis] += step;
      if (map.holds(next) && map.cells[map.index(next)] == CellState::kUnknown) return true;
    }
  }
  return false;
}

/// Adds the waiting neighbours of a cell and marks them as taken.
void take_neighbours(const CoarseMap& map, std::size_t index, FrontierRegions& result, Cells& out) {
  const auto [x, y, z] = map.cell_at(index);
  for (int dz = -1; dz <= 1; ++dz) {
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        const std::array<int, 3> next = {x + dx, y + dy, z + dz};
        if (!map.holds(next)) continue;
        int& region = result.region_of[map.index(next)];
        if (region != kWaiting) continue;
        region = FrontierRegions::kNone;
        out.push_back(map.index(next));
      }
    }
  }
}

/// Halves the cells at the middle of their longest side; false when they are short enough.
bool halve(const CoarseMap& map, double longest, Cells& cells, Cells& rest) {
  std::array<int, 3> low = map.cell_at(cells.front());
  std::array<int, 3> high = low;
  for (const std::size_t index : cells) {
    const std::array<int, 3> cell = map.cell_at(index);
    for (std::size_t i = 0; i < 3; ++i) {
      low[i] = std::min(low[i], cell[i]);
      high[i] = std::max(high[i], cell[i]);
    }
  }
  std::size_t axis = 0;
  for (std::size_t i = 1; i < 3; ++i) {
    if (high[i] - low[i] > high[axis] - low[axis]) axis = i;
  }
  const int length = high[axis] - low[axis] + 1;
  if (length == 1 || length * map.edge <= longest * (1 + 1e-9)) return false;
  const int middle = low[axis] + length / 2;
  const auto cut = std::stable_partition(
      cells.begin(), cells.end(), [&](std::size_t i) { return map.cell_at(i)[axis] < middle; });
  rest.assign(cut, cells.end());
  cells.erase(cut, cells.end());
  return true;
}

FrontierRegion describe(const CoarseMap& map, const Cells& cells) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const std::size_t index : cells) mean += map.centre(index);
  mean /= static_cast<double>(cells.size());
  FrontierRegion region{.centre = mean, .cells = cells.size(), .area = 0};
  double nearest = std::numeric_limits<double>::infinity();
  for (const std::size_t index : cells) {
    const double distance = (map.centre(index) - mean).squaredNorm();
    if (distance >= nearest) continue;
    nearest = distance;
    region.centre = map.centre(index);
  }
  region.area = static_cast<double>(cells.size()) * map.edge * map.edge;
  return region;
}

void add_regions(const CoarseMap& map, double longest, Cells cells, FrontierRegions& result) {
  std::vector<Cells> parts;
  parts.push_back(std::move(cells));
  while (!parts.empty()) {
    Cells part = std::move(parts.back());
    parts.pop_back();
    for (Cells rest; halve(map, longest, part, rest); rest.clear()) parts.push_back(rest);
    for (const std::size_t index : part) {
      result.region_of[index] = static_cast<int>(result.regions.size());
    }
    result.regions.push_back(describe(map, part));
  }
}

}  // namespace

FrontierRegions frontier_regions(const CoarseMap& map, double longest) {
  FrontierRegions result;
  result.region_of.assign(map.cells.size(), FrontierRegions::kNone);
  for (std::size_t i = 0; i < map.cells.size(); ++i) {
    if (map.cells[i] != CellState::kFree || !has_unknown_face(map, i)) continue;
    result.region_of[i] = kWaiting;
    ++result.cells;
  }
  for (std::size_t i = 0; i < map.cells.size(); ++i) {
    if (result.region_of[i] != kWaiting) continue;
    result.region_of[i] = FrontierRegions::kNone;
    Cells touching = {i};
    for (std::size_t k = 0; k < touching.size(); ++k) {
      take_neighbours(map, touching[k], result, touching);
    }
    std::sort(touching.begin(), touching.end());
    add_regions(map, longest, std::move(touching), result);
  }
  return result;
}

}  // namespace facula
