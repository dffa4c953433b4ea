// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/map/coarse_map.hpp>

#include <algorithm>

namespace facula {
namespace {

constexpr double kMostCells = 67108864.0;  // 2^26

/// Coarse keys of the box: low inclusive, high exclusive.
struct CoarseBox {
  std::array<int, 3> low = {kKeyLimit, kKeyLimit, kKeyLimit};
  std::array<int, 3> high = {0, 0, 0};
};

int level_for(double resolution, double least_edge) {
  int level = 0;
  while (level < kBrickLevel && resolution * (1 << level) < least_edge * (1 - 1e-9)) ++level;
  return level;
}

CoarseBox known_box(const OccupancyMap& map, int level) {
  CoarseBox box;
  map.for_each_brick([&](const OccupancyMap::BrickView& brick) {
    for_each_cell(brick.known, [&](std::size_t cell) {
      for (std::size_t i = 0; i < 3; ++i) {
        const int key = (brick.first[i] + static_cast<int>(cell >> (3 * i) & 7)) >> level;
        box.low[i] = std::min(box.low[i], key);
        box.high[i] = std::max(box.high[i], key + 1);
      }
    });
  });
  require(box.low[0] < box.high[0], "the map is empty; there is nothing to look from");
  return box;
}

}  // namespace

CoarseMap coarse_map(const OccupancyMap& map, const CoarseOptions& options) {
  const int level = level_for(map.resolution(), options.least_edge);
  CoarseBox box = known_box(map, level);
  CoarseMap coarse;
  coarse.edge = map.resolution() * (1 << level);
  const int margin = static_cast<int>(
      std::clamp(std::ceil(options.margin / coarse.edge), 0.0, static_cast<double>(kKeyLimit)));
  double cells = 1;
  for (std::size_t i = 0; i < 3; ++i) {
    if (i < 2) {
      box.low[i] -= margin;
      box.high[i] += margin;
    }
    coarse.size[i] = box.high[i] - box.low[i];
    coarse.corner[static_cast<Eigen::Index>(i)] =
        (box.low[i] - (kCentreKey >> level)) * coarse.edge;
    cells *= coarse.size[i];
  }
  require(cells <= kMostCells,
          "a box of ",
          cells,
          " cells of ",
          coarse.edge,
          " m around the map is too large to look for frontiers in; use coarser cells or a shorter "
          "range");
  std::vector<std::uint16_t> known(static_cast<std::size_t>(cells), 0);
  coarse.cells.assign(known.size(), CellState::kUnknown);
  map.for_each_brick([&](const OccupancyMap::BrickView& brick) {
    for_each_cell(brick.known, [&](std::size_t cell) {
      std::array<int, 3> place{};
      for (std::size_t i = 0; i < 3; ++i) {
        place[i] = ((brick.first[i] + static_cast<int>(cell >> (3 * i) & 7)) >> level) - box.low[i];
      }
      const std::size_t index = coarse.index(place);
      ++known[index];
      if (brick.occupied.test(cell)) coarse.cells[index] = CellState::kOccupied;
    });
  });
  const int half = std::max(1, (1 << (3 * level)) / 2);
  for (std::size_t i = 0; i < known.size(); ++i) {
    if (known[i] >= half && coarse.cells[i] == CellState::kUnknown) {
      coarse.cells[i] = CellState::kFree;
    }
  }
  return coarse;
}

}  // namespace facula
