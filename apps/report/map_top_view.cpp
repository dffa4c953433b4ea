// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/apps/report/color_bar.hpp>
#include <facula/apps/report/legend.hpp>
#include <facula/apps/report/map_top_view.hpp>
#include <facula/apps/report/plot_axes.hpp>
#include <facula/apps/report/text.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <string>

#include <Eigen/Geometry>

namespace facula {
namespace {

constexpr Color kFreeColor{255, 255, 255};
constexpr Color kOccupiedColor{30, 34, 42};
constexpr Color kUnknownColor{218, 222, 228};
constexpr Color kPoseColor{196, 44, 48};
constexpr const char* kScanMark = "scan, stroke along its x axis";
constexpr double kMostCells = 4000;  // of a height map along its longer side [1]

/// A map's picture and where the world is on it.
struct MapPlot {
  Image8 canvas;
  Eigen::Vector2d low = Eigen::Vector2d::Zero();  // world x, y of the lower left corner [m]
  double pixels_per_metre = 1;

  Eigen::Vector2d pixel(const Eigen::Vector2d& world) const {
    const PixelBox area = plot_area(canvas);
    const Eigen::Vector2d offset = (world - low) * pixels_per_metre;
    return {area.x - 0.5 + offset.x(), area.y + area.height - 0.5 - offset.y()};
  }
};

std::uint8_t most_telling(const NavigationGrid& grid, const CellBlock& block) {
  std::uint8_t result = NavigationGrid::kUnknown;
  for (int row = block.row_begin; row < block.row_end; ++row) {
    for (int col = block.col_begin; col < block.col_end; ++col) {
      const std::uint8_t cell = grid.cells[static_cast<std::size_t>(row) * grid.cols + col];
      if (cell == NavigationGrid::kOccupied) return cell;
      if (cell == NavigationGrid::kFree) result = cell;
    }
  }
  return result;
}

/// `upper_left` is the world x, y of the picture's corner [m].
MapPlot map_plot(const Image8& cells, const Eigen::Vector2d& upper_left, double pixels_per_metre) {
  const Eigen::Vector2d low = upper_left - Eigen::Vector2d(0, cells.rows / pixels_per_metre);
  MapPlot plot{make_plot(cells.rows, cells.cols), low, pixels_per_metre};
  paste(plot.canvas, cells, kPlotMargin.x, kPlotMargin.y);
  const Eigen::Vector2d high = low + Eigen::Vector2d(cells.cols, cells.rows) / pixels_per_metre;
  draw_axes(plot.canvas, {low.x(), high.x(), "x [m]"}, {low.y(), high.y(), "y [m], north up"});
  return plot;
}

void draw_poses(MapPlot& plot, const std::vector<RigidTransform>& world_from_scan) {
  constexpr double kStroke = 24;  // along the scan's x axis [px]
  for (std::size_t i = 0; i < world_from_scan.size(); ++i) {
    const RigidTransform& pose = world_from_scan[i];
    const Eigen::Vector2d at = plot.pixel(pose.translation.head<2>());
    const Eigen::Vector3d ahead = pose.rotation * Eigen::Vector3d::UnitX();
    const Eigen::Vector2d tip = at + kStroke * Eigen::Vector2d(ahead.x(), -ahead.y());
    draw_line(plot.canvas, at, tip, {kPaper, 5});
    draw_disc(plot.canvas, at, 12, kPaper);
    draw_line(plot.canvas, at, tip, {kPoseColor, 2.5});
    draw_disc(plot.canvas, at, 10.5, kPoseColor);
    draw_text(plot.canvas,
              at,
              std::to_string(i + 1),
              {.size = i < 9 ? 17.0 : 13.0, .color = kPaper, .align = TextAlign::kCenter});
  }
}

/// The legend with a scale bar at its right end.
Image8 map_foot(std::vector<LegendEntry> entries, const std::string& marks, const MapPlot& plot) {
  if (!marks.empty()) entries.push_back({kPoseColor, marks});
  const int bar_room = plot.canvas.cols / 4 + 40;
  const Image8 strip = legend(entries, std::max(200, plot.canvas.cols - bar_room));
  Image8 foot = make_canvas(std::max(48, strip.rows), strip.cols + bar_room);
  paste(foot, strip, 0, 6);
  draw_scale_bar(foot, {strip.cols + 20.0, 34}, plot.pixels_per_metre, bar_room * 3);
  return foot;
}

/// The cells of the map that are drawn, each told to `visit` as its centre and edge [m].
void for_each_occupied(const OccupancyMap& map,
                       double cut_height,
                       const std::function<void(const Eigen::Vector3d&, double)>& visit) {
  map.for_each_leaf([&](const Eigen::Vector3d& center, CellState state, double edge) {
    if (state == CellState::kOccupied && center.z() <= cut_height) visit(center, edge);
  });
}

/// The highest occupied cell of every column, in cells large enough for any extent.
HeightMap drawn_heights(const OccupancyMap& map, double cut_height) {
  HeightMap heights;
  Eigen::AlignedBox2d box;
  for_each_occupied(map, cut_height, [&](const Eigen::Vector3d& center, double edge) {
    box.extend(center.head<2>() - Eigen::Vector2d::Constant(edge / 2));
    box.extend(center.head<2>() + Eigen::Vector2d::Constant(edge / 2));
  });
  if (box.isEmpty()) return heights;
  heights.origin = box.min();
  heights.resolution = std::max(map.resolution(), box.sizes().maxCoeff() / kMostCells);
  heights.cols = std::max(1, static_cast<int>(std::lround(box.sizes().x() / heights.resolution)));
  heights.rows = std::max(1, static_cast<int>(std::lround(box.sizes().y() / heights.resolution)));
  heights.top.assign(static_cast<std::size_t>(heights.rows) * heights.cols,
                     std::numeric_limits<float>::quiet_NaN());
  const auto span = [&](double center, double edge, double low, int count) {
    const auto begin =
        static_cast<int>(std::floor((center - edge / 2 - low) / heights.resolution + 0.5));
    const auto end =
        static_cast<int>(std::floor((center + edge / 2 - low) / heights.resolution + 0.5));
    const int first = std::clamp(begin, 0, count - 1);
    return std::array<int, 2>{first, std::clamp(end, first + 1, count)};
  };
  for_each_occupied(map, cut_height, [&](const Eigen::Vector3d& center, double edge) {
    const auto cols = span(center.x(), edge, heights.origin.x(), heights.cols);
    const auto rows = span(center.y(), edge, heights.origin.y(), heights.rows);
    const auto top = static_cast<float>(center.z() + edge / 2);
    for (int y = rows[0]; y < rows[1]; ++y) {
      for (int x = cols[0]; x < cols[1]; ++x) {
        float& height =
            heights.top[static_cast<std::size_t>(heights.rows - 1 - y) * heights.cols + x];
        if (!(height >= top)) height = top;
      }
    }
  });
  return heights;
}

float highest(const HeightMap& heights, const CellBlock& block) {
  float result = std::numeric_limits<float>::quiet_NaN();
  for (int row = block.row_begin; row < block.row_end; ++row) {
    for (int col = block.col_begin; col < block.col_end; ++col) {
      const float height = heights.top[static_cast<std::size_t>(row) * heights.cols + col];
      if (!(result >= height) && std::isfinite(height)) result = height;
    }
  }
  return result;
}

GridLayout square_layout(int rows, int cols) {
  return grid_layout(rows, cols, {.least = 460, .most = 1100, .square_cells = true});
}

}  // namespace

GridLayout map_layout(const NavigationGrid& grid) {
  return square_layout(grid.rows, grid.cols);
}

Image8 map_top_view(const NavigationGrid& grid,
                    const std::vector<RigidTransform>& world_from_scan,
                    const std::string& marks) {
  if (grid.rows < 1 || grid.cols < 1) return empty_picture("The navigation grid has no cells.");
  require(grid.cells.size() == static_cast<std::size_t>(grid.rows) * grid.cols,
          "a grid of ",
          grid.rows,
          " x ",
          grid.cols,
          " needs as many cells, not ",
          grid.cells.size());
  require(grid.resolution > 0, "resolution must be above 0 m, not ", grid.resolution);
  const GridLayout layout = map_layout(grid);
  const Image8 cells = paint_grid(layout, [&](const CellBlock& block) {
    const std::uint8_t cell = most_telling(grid, block);
    if (cell == NavigationGrid::kOccupied) return kOccupiedColor;
    return cell == NavigationGrid::kFree ? kFreeColor : kUnknownColor;
  });
  const double scale = layout.scale_x / (grid.resolution * layout.step_x);
  const Eigen::Vector2d upper_left = grid.origin + Eigen::Vector2d(0, grid.rows * grid.resolution);
  MapPlot plot = map_plot(cells, upper_left, scale);
  draw_poses(plot, world_from_scan);
  const std::vector<LegendEntry> entries{
      {kFreeColor, "free"}, {kOccupiedColor, "occupied"}, {kUnknownColor, "unknown"}};
  return below({plot.canvas, map_foot(entries, world_from_scan.empty() ? "" : marks, plot)});
}

Image8 map_top_view(const HeightMap& heights, const std::vector<RigidTransform>& world_from_scan) {
  require(heights.rows > 0 && heights.cols > 0 && heights.top.size() == heights.size(),
          "a height map of ",
          heights.rows,
          " x ",
          heights.cols,
          " needs as many heights, not ",
          heights.top.size());
  const ValueRange range = robust_range(heights.top, 0.001);
  const ColorScale scale{ColorMap::kViridis, range.low, range.high, "height z [m]"};
  const GridLayout layout = square_layout(heights.rows, heights.cols);
  const Image8 cells = paint_grid(layout, [&](const CellBlock& block) {
    const float height = highest(heights, block);
    return std::isnan(height) ? kFreeColor : scale.at(height);
  });
  const Eigen::Vector2d upper_left =
      heights.origin + Eigen::Vector2d(0, heights.rows * heights.resolution);
  MapPlot plot = map_plot(cells, upper_left, layout.scale_x / (heights.resolution * layout.step_x));
  draw_poses(plot, world_from_scan);
  const Image8 foot =
      map_foot({{kFreeColor, "nothing occupied"}}, world_from_scan.empty() ? "" : kScanMark, plot);
  const Image8 bar = color_bar(scale, plot.canvas.rows - kPlotMargin.height + 14);
  return below({beside({plot.canvas, bar}), foot});
}

Image8 map_top_view(const OccupancyMap& map,
                    const std::vector<RigidTransform>& world_from_scan,
                    double cut_height) {
  const HeightMap heights = drawn_heights(map, cut_height);
  if (heights.top.empty()) return empty_picture("The map has no occupied cell.");
  return map_top_view(heights, world_from_scan);
}

}  // namespace facula
