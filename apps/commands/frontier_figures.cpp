// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/apps/commands/frontier_figures.hpp>
#include <facula/apps/report/map_top_view.hpp>
#include <facula/map/navigation_grid.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace facula {
namespace {

FigureTable suggestion_table(const Frontiers& frontiers) {
  FigureTable table{.key = "next_scans",
                    .title = "Places, the best first:",
                    .columns = {{"rank", "place", 0},
                                {"x_m", "x", 2},
                                {"y_m", "y", 2},
                                {"z_m", "z", 2},
                                {"volume_m3", "sees", 1},
                                {"volume_alone_m3", "alone", 1},
                                {"region_x_m", "frontier x", 2},
                                {"region_y_m", "y", 2},
                                {"region_z_m", "z", 2},
                                {"region_area_m2", "area", 1}},
                    .rows = {}};
  for (const ScanSuggestion& s : frontiers.suggestions) {
    std::vector<FigureValue> row = {static_cast<long long>(table.rows.size() + 1)};
    for (const double value : {s.position.x(),
                               s.position.y(),
                               s.position.z(),
                               s.volume,
                               s.volume_alone,
                               s.region.centre.x(),
                               s.region.centre.y(),
                               s.region.centre.z(),
                               s.region.area}) {
      row.emplace_back(value);
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

/// Turned so that its x axis points to the frontier.
RigidTransform mark_of(const ScanSuggestion& suggestion) {
  const Eigen::Vector3d way = suggestion.region.centre - suggestion.position;
  RigidTransform mark;
  mark.translation = suggestion.position;
  mark.rotation = Eigen::AngleAxisd(std::atan2(way.y(), way.x()), Eigen::Vector3d::UnitZ());
  return mark;
}

}  // namespace

void report_floor(const Floor& floor, Figures& figures) {
  figures.number("floor_height_m", "height", floor.height, 3);
  if (floor.area == 0) return;  // it was given
  figures.number("floor_top_m", "upper face of its cells", floor.top, 3);
  figures.number("floor_spread_m", "spread of its cells", floor.spread, 3);
  figures.number("floor_area_m2", "area", floor.area, 2);
  figures.number("floor_share_percent", "of the known columns", 100 * floor.share, 1);
}

void report_height_map(const HeightMap& heights, double max_height, Figures& figures) {
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  std::size_t known = 0;
  for (const float top : heights.top) {
    if (std::isnan(top)) continue;
    ++known;
    low = std::min(low, static_cast<double>(top));
    high = std::max(high, static_cast<double>(top));
  }
  figures.count("height_map_cols", "columns", static_cast<std::size_t>(heights.cols));
  figures.count("height_map_rows", "rows", static_cast<std::size_t>(heights.rows));
  figures.numbers(
      "height_map_origin_m", "lower left corner", {heights.origin.x(), heights.origin.y()}, 3);
  figures.number("height_map_limit_m", "nothing above", max_height, 3);
  figures.count("height_map_cells", "cells with a height", known);
  if (known > 0) figures.numbers("height_map_range_m", "heights", {low, high}, 3);
}

void report_frontiers(const Frontiers& frontiers, Figures& figures) {
  figures.number("frontier_cell_mm", "cells counted in", 1000 * frontiers.cell, 1);
  figures.count("frontier_cells", "frontier cells", frontiers.cells);
  figures.count("frontier_regions", "regions of them", frontiers.regions);
  figures.count("standpoints", "places tried", frontiers.standpoints);
  figures.count("rays", "rays from each", frontiers.rays);
  if (frontiers.suggestions.empty())
    figures.note("No place would show more than is known.");
  else
    figures.table(suggestion_table(frontiers));
}

Image8 frontier_picture(const OccupancyMap& map, const Floor& floor, const Frontiers& frontiers) {
  double height = floor.top + std::max(1.0, map.resolution());  // where there are no places
  std::vector<RigidTransform> marks;
  for (const ScanSuggestion& suggestion : frontiers.suggestions) {
    height = std::max(height, suggestion.position.z());
    marks.push_back(mark_of(suggestion));
  }
  return map_top_view(navigation_grid(map, {.min_height = floor.top, .max_height = height}),
                      marks,
                      "next scan, stroke towards what is new");
}

}  // namespace facula
