// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/map/cell_box.hpp>
#include <facula/map/coarse_map.hpp>

#include <algorithm>

namespace facula {
namespace {

constexpr double kMostCells = 67108864.0;  // 2^26

/// Coarse keys of the box: low inclusive, high exclusive.
struct CoarseBox {
  std::array<int, 3> low{};
  std::array<int, 3> high{};
};

int level_for(double resolution, double least_edge) {
  int level = 0;
  while (level < kBrickLevel && resolution * (1 << level) < least_edge * (1 - 1e-9)) ++level;
  return level;
}

CoarseBox coarse_box(const OccupancyMap& map, int level) {
  const auto known = known_box(map);
  require(known.has_value(), "the map is empty; there is nothing to look from");
  CoarseBox box;
  for (std::size_t i = 0; i < 3; ++i) {
    box.low[i] = known->low[i] >> level;
    box.high[i] = (known->high[i] >> level) + 1;
  }
  return box;
}

}  // namespace

CoarseMap coarse_map(const OccupancyMap& map, const CoarseOptions& options) {
  const int level = level_for(map.resolution(), options.least_edge);
  CoarseBox box = coarse_box(map, level);
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
      std::array<int, 3> place = cell_at(brick.first, cell);
      for (std::size_t i = 0; i < 3; ++i) place[i] = (place[i] >> level) - box.low[i];
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
