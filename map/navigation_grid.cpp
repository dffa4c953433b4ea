// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/map/cell_layers.hpp>
#include <facula/map/navigation_grid.hpp>
#include <facula/map/plan_frame.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace facula {
namespace {

constexpr float kNothingKnown = -std::numeric_limits<float>::infinity();

PlanFrame frame_between(const OccupancyMap& map, const NavigationGridOptions& options) {
  const CellLayers layers =
      layers_between(options.min_height, options.max_height, map.resolution());
  const auto frame = plan_frame(map, [&](const OccupancyMap::BrickView& brick) {
    return brick.known & mask_of(layers, brick.first[2]);
  });
  require(frame.has_value(),
          "the map has no known cell between the heights ",
          options.min_height,
          " m and ",
          options.max_height,
          " m; choose heights that the scans have seen");
  return *frame;
}

/// The largest log-odds of every column between the heights.
std::vector<float> largest_log_odds(const OccupancyMap& map,
                                    const NavigationGridOptions& options,
                                    const PlanFrame& frame) {
  const CellLayers layers =
      layers_between(options.min_height, options.max_height, map.resolution());
  std::vector<float> largest(frame.size(), kNothingKnown);
  LogOddsBrick::Values values{};
  for (const LogOddsMap::Entry& entry : map.bricks().entries()) {
    const CellKey first = first_cell(entry.code);
    const CellMask band = mask_of(layers, first[2]);
    if (band.none()) continue;
    for_each_cell(entry.brick.read(values) & band, [&](std::size_t cell) {
      const CellKey key = cell_at(first, cell);
      float& column = largest[frame.index(key[0], key[1])];
      column = std::max(column, values[cell]);
    });
  }
  return largest;
}

/// Rounded so that 50 % and more is what the map calls occupied.
std::int8_t percent_of(float log_odds) {
  const double percent = std::round(100 / (1 + std::exp(-static_cast<double>(log_odds))));
  return static_cast<std::int8_t>(is_occupied(log_odds) ? std::max(percent, 50.0)
                                                        : std::min(percent, 49.0));
}

}  // namespace

void NavigationGridOptions::check() const {
  require(std::isfinite(min_height) && std::isfinite(max_height) && max_height > min_height,
          "NavigationGridOptions: expected max_height above min_height, got ",
          min_height,
          " m to ",
          max_height,
          " m");
  require(std::isfinite(inflation) && inflation >= 0,
          "NavigationGridOptions: expected inflation of 0 m (none) or more, got ",
          inflation);
}

NavigationGrid navigation_grid(const OccupancyMap& map, const NavigationGridOptions& options) {
  options.check();
  const PlanFrame frame = frame_between(map, options);
  NavigationGrid grid{.rows = frame.rows,
                      .cols = frame.cols,
                      .resolution = frame.resolution,
                      .origin = frame.origin(),
                      .cells = {}};
  grid.cells.reserve(frame.size());
  grid.occupancy.reserve(frame.size());
  for (const float log_odds : largest_log_odds(map, options, frame)) {
    const bool known = log_odds != kNothingKnown;
    grid.cells.push_back(!known                  ? NavigationGrid::kUnknown
                         : is_occupied(log_odds) ? NavigationGrid::kOccupied
                                                 : NavigationGrid::kFree);
    grid.occupancy.push_back(known ? percent_of(log_odds) : std::int8_t{-1});
  }
  inflate(grid, options.inflation);
  return grid;
}

}  // namespace facula
