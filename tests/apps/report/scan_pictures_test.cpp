// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/random.hpp>
#include <facula/apps/report/color_map.hpp>
#include <facula/apps/report/plot_axes.hpp>
#include <facula/apps/report/range_image.hpp>
#include <facula/apps/report/scan_picture.hpp>
#include <facula/apps/report/stripe_over_frame.hpp>
#include <facula/tests/support/matchers.hpp>

#include <limits>

#include <gtest/gtest.h>

namespace facula {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

/// 100 x 50 cells; every column's origin lies 10 m off, the distance from it is 1 m above and 2 m
/// below; cell (20, 30) is missing.
PolarScan two_step_scan() {
  PolarScan scan = PolarScan::empty(100, 50);
  for (int col = 0; col < 50; ++col) {
    scan.sensor_origin[static_cast<std::size_t>(col)] = {10, 0, 0};
    for (int row = 0; row < 100; ++row) {
      if (row == 20 && col == 30) continue;
      scan.set(scan.index(row, col), {10, row < 50 ? 1.0 : 2.0, 0}, 1, 0.001F);
    }
  }
  return scan;
}

Color cell_color(const Image8& picture, const GridLayout& layout, int row, int col) {
  return pixel_color(picture, kPlotMargin.x + layout.x_of(col), kPlotMargin.y + layout.y_of(row));
}

TEST(RangeImage, PutsTheRightColourAtTheRightPlace) {
  const PolarScan scan = two_step_scan();
  const GridLayout layout = range_image_layout(scan);
  const Image8 picture = range_image(scan);
  EXPECT_GT(picture.cols, kPlotMargin.x + layout.width());
  EXPECT_EQ(cell_color(picture, layout, 0, 0), color_at(ColorMap::kViridis, 0));
  EXPECT_EQ(cell_color(picture, layout, 49, 49), color_at(ColorMap::kViridis, 0));
  EXPECT_EQ(cell_color(picture, layout, 50, 0), color_at(ColorMap::kViridis, 1));
  EXPECT_EQ(cell_color(picture, layout, 99, 49), color_at(ColorMap::kViridis, 1));
  EXPECT_EQ(cell_color(picture, layout, 20, 30), kNoDataColor);
  EXPECT_EQ(cell_color(picture, layout, 30, 20), color_at(ColorMap::kViridis, 0));
}

TEST(RangeImage, EnlargesNarrowScansAndReducesLargeOnes) {
  const GridLayout narrow = range_image_layout(PolarScan::empty(480, 8));
  EXPECT_GE(narrow.width(), 400);
  EXPECT_GE(narrow.height(), 400);
  const GridLayout large = range_image_layout(PolarScan::empty(1080, 7200));
  EXPECT_LE(large.width(), 1200);
  EXPECT_LE(large.height(), 1200);
  EXPECT_LT(large.x_of(7199), large.width());
}

TEST(RangeImage, SaysWhenThereIsNothingToSee) {
  EXPECT_EQ(range_image(PolarScan::empty(0, 0)).rows, 160);
  EXPECT_EQ(range_image(PolarScan::empty(10, 10)).rows, 160);
}

TEST(RangeImage, RefusesAScanWhoseArraysDoNotFit) {
  PolarScan scan = two_step_scan();
  scan.range.pop_back();
  EXPECT_FALSE(error_of([&] { range_image(scan); }).empty());
}

TEST(ScanPicture, ShowsThePointNearestToTheViewer) {
  // A red sheet in front of a green one (seen along y), both full of points.
  PointCloud cloud;
  for (int i = 0; i <= 200; ++i) {
    for (int k = 0; k <= 200; ++k) {
      for (const bool front : {true, false}) {
        cloud.points.emplace_back(i / 200.0F, front ? 0.0F : 0.5F, k / 200.0F);
        cloud.colors.push_back(front ? Color{200, 0, 0} : Color{0, 200, 0});
      }
    }
  }
  const Image8 picture = scan_picture(cloud, {.panel = 200});
  const Color seen = pixel_color(picture, 100, 34 + 100);
  EXPECT_GT(seen[0], 150);
  EXPECT_LT(seen[1], 30);
}

TEST(ScanPicture, LeavesOutPointsThatLookAway) {
  // Floor and ceiling of a room: from above the ceiling looks away.
  PointCloud cloud;
  for (int i = 0; i <= 200; ++i) {
    for (int k = 0; k <= 200; ++k) {
      for (const bool floor : {true, false}) {
        cloud.points.emplace_back(i / 200.0F, k / 200.0F, floor ? 0.0F : 1.0F);
        cloud.normals.emplace_back(0.0F, 0.0F, floor ? 1.0F : -1.0F);
        cloud.colors.push_back(floor ? Color{0, 0, 200} : Color{200, 0, 0});
      }
    }
  }
  const int x = 2 * 210 + 100;
  EXPECT_GT(pixel_color(scan_picture(cloud, {.panel = 200}), x, 134)[2], 100);
  EXPECT_GT(pixel_color(scan_picture(cloud, {.panel = 200, .hide_backs = false}), x, 134)[0], 100);
}

TEST(ScanPicture, SurvivesCloudsOfAnyKind) {
  EXPECT_EQ(scan_picture({}).rows, 160);
  PointCloud cloud;
  cloud.points = {{kNaN, 0, 0}};
  EXPECT_EQ(scan_picture(cloud).rows, 160);
  cloud.points.push_back({1, 2, 3});
  EXPECT_GT(scan_picture(cloud).cols, 3 * 400);
  cloud.points.push_back({3e38F, -3e38F, 3e38F});
  EXPECT_GT(scan_picture(cloud).cols, 3 * 400);
  cloud.intensity = {1};
  EXPECT_FALSE(error_of([&] { scan_picture(cloud); }).empty());
}

StripeProfile upright_stripe(std::size_t rows, float position) {
  StripeProfile profile = StripeProfile::none(rows);
  for (std::size_t i = 0; i < rows; ++i) {
    profile.seen[i] = i == 10 ? 0 : 1;
    profile.position[i] = position;
  }
  return profile;
}

TEST(StripeOverFrame, DrawsTheStripeToAFractionOfAPixelAndMarksWhatIsMissing) {
  const Image8 frame(30, 40, 1);  // black, enlarged 16 times
  const Image8 picture = stripe_over_frame(frame.view(), upright_stripe(30, 12.25F));
  const int gutter = 8;
  const double x = gutter + (12.25 + 0.5) * 16 - 0.5;
  const int y = gutter + 20 * 16;
  double sum = 0;
  double mean = 0;
  for (int col = gutter; col < picture.cols; ++col) {
    const double cyan = pixel_color(picture, col, y)[2];
    sum += cyan;
    mean += cyan * col;
  }
  ASSERT_GT(sum, 0);
  EXPECT_NEAR(mean / sum, x, 0.1);
  const Color missing = pixel_color(picture, 4, gutter + 10 * 16 + 8);
  EXPECT_NE(missing, pixel_color(picture, 4, gutter + 12 * 16 + 8));
  EXPECT_EQ(pixel_color(picture, gutter + 12 * 16 + 12, gutter + 10 * 16 + 8), (Color{0, 0, 0}));
}

TEST(StripeOverFrame, TurnsWithTheDirectionOfTheLine) {
  const Image8 frame(40, 30, 3);
  const StripeProfile profile = upright_stripe(30, 12.0F);
  const Image8 picture = stripe_over_frame(frame.view(), profile, StripeDirection::kPerColumn);
  const int y = 8 + 12 * 16 + 8;
  EXPECT_GT(pixel_color(picture, 8 + 20 * 16, y)[2], 100);
  EXPECT_EQ(pixel_color(picture, 8 + 20 * 16, y + 40)[2], 0);
}

TEST(StripeOverFrame, ReducesLargeFramesAndRefusesForeignProfiles) {
  const Image8 frame(3000, 4000, 1);
  const Image8 picture = stripe_over_frame(frame.view(), StripeProfile::none(3000));
  EXPECT_LE(picture.cols, 1610);
  EXPECT_EQ(stripe_over_frame({}, StripeProfile::none(0)).rows, 160);
  EXPECT_NE(error_of([&] { stripe_over_frame(frame.view(), StripeProfile::none(7)); }).find('7'),
            std::string::npos);
}

}  // namespace
}  // namespace facula
