// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/map/cell_box.hpp>
#include <facula/map/place_text.hpp>

#include <algorithm>

namespace facula {

std::size_t CellBox::cells() const {
  return static_cast<std::size_t>(size(0)) * static_cast<std::size_t>(size(1)) *
         static_cast<std::size_t>(size(2));
}

std::optional<CellBox> known_box(const OccupancyMap& map) {
  CellBox box{{kKeyLimit, kKeyLimit, kKeyLimit}, {-1, -1, -1}};
  for (const LogOddsMap::Entry& entry : map.bricks().entries()) {
    const CellKey first = first_cell(entry.code);
    const CellKey last = {
        first[0] + kBrickEdge - 1, first[1] + kBrickEdge - 1, first[2] + kBrickEdge - 1};
    if (box.contains(first) && box.contains(last)) continue;
    for_each_cell(entry.brick.known(), [&](std::size_t cell) {
      const CellKey key = cell_at(first, cell);
      for (std::size_t i = 0; i < 3; ++i) {
        box.low[i] = std::min(box.low[i], key[i]);
        box.high[i] = std::max(box.high[i], key[i]);
      }
    });
  }
  if (box.high[0] < 0) return std::nullopt;
  return box;
}

CellBox cell_box(const MapBox& box, double resolution) {
  const auto low = cell_of(box.min.cast<double>(), resolution);
  const auto high = cell_of(box.max.cast<double>(), resolution);
  const bool ordered = (box.min.array() <= box.max.array()).all();
  require(low && high && ordered,
          "expected a box whose lower corner is not above its upper one, both within ",
          kCentreKey,
          " cells of the origin, got ",
          place_text(box.min),
          " m to ",
          place_text(box.max),
          " m at a cell of ",
          1000 * resolution,
          " mm; give another box");
  return {*low, *high};
}

CellBox grown(const CellBox& box, int cells) {
  CellBox result = box;
  for (std::size_t i = 0; i < 3; ++i) {
    result.low[i] = std::max(box.low[i] - cells, 0);
    result.high[i] = std::min(box.high[i] + cells, kKeyLimit - 1);
  }
  return result;
}

std::optional<CellBox> common_cells(const CellBox& a, const CellBox& b) {
  CellBox result;
  for (std::size_t i = 0; i < 3; ++i) {
    result.low[i] = std::max(a.low[i], b.low[i]);
    result.high[i] = std::min(a.high[i], b.high[i]);
    if (result.low[i] > result.high[i]) return std::nullopt;
  }
  return result;
}

}  // namespace facula
