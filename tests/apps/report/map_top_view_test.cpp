// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/apps/report/color_map.hpp>
#include <facula/apps/report/map_top_view.hpp>
#include <facula/apps/report/plot_axes.hpp>
#include <facula/tests/support/matchers.hpp>

#include <cmath>

#include <gtest/gtest.h>

namespace facula {
namespace {

/// 20 x 30 cells of 0.1 m, lower left corner at (-1, 2): row 0 occupied, the west column of the
/// other rows unknown, the rest free.
NavigationGrid example_grid() {
  NavigationGrid grid{.rows = 20, .cols = 30, .resolution = 0.1, .origin = {-1, 2}, .cells = {}};
  for (int row = 0; row < grid.rows; ++row) {
    for (int col = 0; col < grid.cols; ++col) {
      std::uint8_t cell = col == 0 ? NavigationGrid::kUnknown : NavigationGrid::kFree;
      if (row == 0) cell = NavigationGrid::kOccupied;
      grid.cells.push_back(cell);
    }
  }
  return grid;
}

Color cell_color(const Image8& picture, const GridLayout& layout, int row, int col) {
  return pixel_color(picture, kPlotMargin.x + layout.x_of(col), kPlotMargin.y + layout.y_of(row));
}

int brightness(const Color& color) {
  return color[0] + color[1] + color[2];
}

TEST(MapTopView, HasNorthUp) {
  const NavigationGrid grid = example_grid();
  const GridLayout layout = map_layout(grid);
  const Image8 picture = map_top_view(grid);
  const Color occupied = cell_color(picture, layout, 0, 15);
  const Color unknown = cell_color(picture, layout, 10, 0);
  const Color free = cell_color(picture, layout, 19, 29);
  EXPECT_LT(brightness(occupied), 200);
  EXPECT_EQ(brightness(free), 3 * 255);
  EXPECT_LT(brightness(unknown), brightness(free));
  EXPECT_GT(brightness(unknown), brightness(occupied));
  EXPECT_EQ(cell_color(picture, layout, 0, 0), occupied);
  EXPECT_EQ(cell_color(picture, layout, 19, 0), unknown);
}

TEST(MapTopView, PutsAScanWhereItStandsAndTurnsItsStroke) {
  const NavigationGrid grid = example_grid();
  const GridLayout layout = map_layout(grid);
  RigidTransform pose;  // in the middle of cell (row 9, col 10), looking north
  pose.translation = {-1 + 1.05, 2 + 1.05, 0.7};
  pose.rotation = Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitZ());
  const Image8 picture = map_top_view(grid, {pose});
  const int x = kPlotMargin.x + layout.x_of(10);
  const int y = kPlotMargin.y + layout.y_of(9);
  const auto is_mark = [&](int px, int py) {
    const Color color = pixel_color(picture, px, py);
    return color[0] > color[2] + 100;
  };
  EXPECT_TRUE(is_mark(x - 8, y));
  EXPECT_TRUE(is_mark(x, y - 20));  // north is up
  EXPECT_FALSE(is_mark(x, y + 20));
}

TEST(MapTopView, KeepsThinWallsInGridsLargerThanThePicture) {
  NavigationGrid grid{
      .rows = 3000, .cols = 5000, .resolution = 0.01, .origin = {0, 0}, .cells = {}};
  grid.cells.assign(3000UL * 5000UL, NavigationGrid::kFree);
  for (std::size_t col = 0; col < 5000; ++col) grid.cells[1501 * 5000 + col] = 0;
  const GridLayout layout = map_layout(grid);
  EXPECT_LE(layout.width(), 1100);
  const Image8 picture = map_top_view(grid);
  EXPECT_LT(brightness(cell_color(picture, layout, 1501, 2500)), 200);
  EXPECT_EQ(brightness(cell_color(picture, layout, 1400, 2500)), 3 * 255);
}

TEST(MapTopView, RefusesAGridWhoseCellsDoNotFitAndShowsAnEmptyOne) {
  NavigationGrid grid = example_grid();
  grid.cells.pop_back();
  EXPECT_NE(error_of([&] { map_top_view(grid); }).find("599"), std::string::npos);
  EXPECT_EQ(map_top_view(NavigationGrid{}).rows, 160);
  EXPECT_EQ(map_top_view(OccupancyMap{}).rows, 160);
}

/// A floor at z = 0.05 with a block of height 1 m in its north-east corner.
OccupancyMap floor_with_block() {
  OccupancyMap map({.resolution = 0.1});
  PointCloud cloud;
  for (int i = 0; i < 20; ++i) {
    for (int k = 0; k < 20; ++k) {
      const bool block = i >= 15 && k >= 15;
      cloud.points.emplace_back(i * 0.1F + 0.05F, k * 0.1F + 0.05F, block ? 0.95F : 0.05F);
      cloud.sensor_origin.emplace_back(cloud.points.back() + Eigen::Vector3f(0, 0, 0.001F));
    }
  }
  map.insert(cloud);
  return map;
}

TEST(MapTopView, ColoursAnOccupancyMapByHeight) {
  const OccupancyMap map = floor_with_block();
  const GridLayout layout = grid_layout(20, 20, {.least = 460, .most = 1100, .square_cells = true});
  const Image8 picture = map_top_view(map);
  EXPECT_EQ(cell_color(picture, layout, 0, 19), color_at(ColorMap::kViridis, 1));
  EXPECT_EQ(cell_color(picture, layout, 19, 0), color_at(ColorMap::kViridis, 0));
  EXPECT_EQ(cell_color(picture, layout, 19, 19), color_at(ColorMap::kViridis, 0));
}

TEST(MapTopView, CutsTheCeilingOff) {
  const GridLayout layout = grid_layout(20, 20, {.least = 460, .most = 1100, .square_cells = true});
  const Image8 picture = map_top_view(floor_with_block(), {}, 0.5);
  EXPECT_EQ(brightness(cell_color(picture, layout, 0, 19)), 3 * 255);
  EXPECT_LT(brightness(cell_color(picture, layout, 19, 0)), 3 * 255);
}

TEST(MapTopView, ColoursAHeightMapAndLeavesGapsWhite) {
  HeightMap heights{.rows = 10, .cols = 20, .resolution = 0.1, .origin = {0, 0}, .top = {}};
  for (int i = 0; i < 200; ++i) heights.top.push_back(i % 20 < 10 ? 0.0F : 1.0F);
  heights.top[0] = std::nanf("");
  const Image8 picture = map_top_view(heights);
  const GridLayout layout = grid_layout(10, 20, {.least = 460, .most = 1100, .square_cells = true});
  EXPECT_EQ(brightness(cell_color(picture, layout, 0, 0)), 3 * 255);
  const Color low = cell_color(picture, layout, 5, 3);
  const Color high = cell_color(picture, layout, 5, 15);
  EXPECT_EQ(low, color_at(ColorMap::kViridis, 0));
  EXPECT_EQ(high, color_at(ColorMap::kViridis, 1));
  heights.top.pop_back();
  EXPECT_NE(error_of([&] { map_top_view(heights); }).find("10 x 20"), std::string::npos);
}

}  // namespace
}  // namespace facula
