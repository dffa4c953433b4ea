// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/apps/report/color_map.hpp>
#include <facula/apps/report/path_picture.hpp>
#include <facula/apps/report/plot_axes.hpp>
#include <facula/tests/map/made_map.hpp>

#include <gtest/gtest.h>

namespace facula {
namespace {

/// 30 x 20 x 10 free cells of 10 cm from the origin on.
OccupancyMap free_hall() {
  OccupancyMap map({.resolution = 0.1});
  for_each_cell_of({near_centre(0, 0, 0), near_centre(29, 19, 9)},
                   [&](const CellKey& cell) { set_cell(map, cell, kFreeValue); });
  return map;
}

/// Along x at y = 1.5 m, the clearance rising evenly.
PathPlan straight_plan() {
  PathPlan plan;
  for (int i = 0; i <= 40; ++i)
    plan.samples.push_back({{0.5 + 0.05 * i, 1.5, 0.5}, 0.2 + 0.01 * i});
  return plan;
}

TEST(PathPicture, DrawsThePathWhereItIsInTheColoursOfItsClearance) {
  const Image8 picture = path_picture(free_hall(), straight_plan(), 0.2);
  // Square pixels: the plot is 3 m wide and 2 m high, below the margin, north up.
  int width = 0;
  const int middle = kPlotMargin.y + 20;
  while (pixel_color(picture, kPlotMargin.x + 1 + width, middle) == Color{255, 255, 255}) ++width;
  const double per_metre = (width + 1) / 3.0;
  const int y = kPlotMargin.y + static_cast<int>(0.5 * per_metre);
  const auto at = [&](double x) {
    return pixel_color(picture, kPlotMargin.x + static_cast<int>(x * per_metre), y);
  };
  EXPECT_EQ(at(0.25), (Color{255, 255, 255}));
  for (const double x : {0.9, 1.5, 2.1}) {
    const Color truth = color_at(ColorMap::kViridis, (x - 0.5) / 2);
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(at(x)[c], truth[c], 25) << x;
  }
}

TEST(PathPicture, RefusesAPathWithoutPlaces) {
  EXPECT_THROW(path_picture(free_hall(), {}, 0.2), Error);
}

}  // namespace
}  // namespace facula
