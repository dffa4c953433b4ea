// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/apps/report/color_bar.hpp>
#include <facula/apps/report/map_top_view.hpp>
#include <facula/apps/report/path_picture.hpp>
#include <facula/apps/report/plot_axes.hpp>
#include <facula/apps/report/text.hpp>

#include <algorithm>
#include <vector>

namespace facula {
namespace {

constexpr Color kEndColor{196, 44, 48};
constexpr int kBarHeight = 320;  // of the colour bar [px]

/// Where the world is on the picture that map_top_view() makes of a grid.
struct GridPixels {
  Eigen::Vector2d upper_left;  // world x, y of the plot area's corner [m]
  double per_metre;            // [px]

  explicit GridPixels(const NavigationGrid& grid)
      : upper_left(grid.origin + Eigen::Vector2d(0, grid.rows * grid.resolution)) {
    const GridLayout layout = map_layout(grid);
    per_metre = layout.scale_x / (grid.resolution * layout.step_x);
  }

  Eigen::Vector2d at(const Eigen::Vector3d& x) const {
    const Eigen::Vector2d offset = (x.head<2>() - upper_left) * per_metre;
    return {kPlotMargin.x - 0.5 + offset.x(), kPlotMargin.y - 0.5 - offset.y()};
  }
};

NavigationGrid grid_around(const OccupancyMap& map, const PathPlan& plan, double radius) {
  double low = plan.samples.front().x.z();
  double high = low;
  for (const PathSample& sample : plan.samples) {
    low = std::min(low, sample.x.z());
    high = std::max(high, sample.x.z());
  }
  return navigation_grid(map, {.min_height = low - radius, .max_height = high + radius});
}

ColorScale scale_of(const PathPlan& plan) {
  std::vector<float> clearances;
  for (const PathSample& sample : plan.samples) {
    clearances.push_back(static_cast<float>(sample.clearance));
  }
  const ValueRange range = robust_range(clearances, 0);
  return {ColorMap::kViridis, range.low, range.high, "clearance [m]"};
}

void draw_end(Image8& canvas, const Eigen::Vector2d& at, const char* name) {
  draw_disc(canvas, at, 9, kPaper);
  draw_disc(canvas, at, 7, kEndColor);
  const Eigen::Vector2d text = at + Eigen::Vector2d(12, -14);
  for (const double right : {-2.0, 0.0, 2.0}) {  // a light seam, to be read over dark cells
    for (const double down : {-2.0, 0.0, 2.0}) {
      draw_text(canvas, text + Eigen::Vector2d(right, down), name, {.size = 17, .color = kPaper});
    }
  }
  draw_text(canvas, text, name, {.size = 17, .color = kEndColor});
}

}  // namespace

Image8 path_picture(const OccupancyMap& map, const PathPlan& plan, double radius) {
  require(!plan.samples.empty(), "expected a path with samples to draw, got an empty one");
  const NavigationGrid grid = grid_around(map, plan, radius);
  const GridPixels pixels(grid);
  const ColorScale scale = scale_of(plan);
  Image8 canvas = map_top_view(grid);
  for (std::size_t i = 1; i < plan.samples.size(); ++i) {
    const PathSample& sample = plan.samples[i];
    draw_line(canvas, pixels.at(plan.samples[i - 1].x), pixels.at(sample.x), {kInk, 6});
  }
  for (std::size_t i = 1; i < plan.samples.size(); ++i) {
    const PathSample& sample = plan.samples[i];
    draw_line(canvas,
              pixels.at(plan.samples[i - 1].x),
              pixels.at(sample.x),
              {scale.at(sample.clearance), 4});
  }
  draw_end(canvas, pixels.at(plan.samples.front().x), "start");
  draw_end(canvas, pixels.at(plan.samples.back().x), "goal");
  return beside({canvas, color_bar(scale, kBarHeight)});
}

}  // namespace facula
