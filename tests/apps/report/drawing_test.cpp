// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/apps/report/color_bar.hpp>
#include <facula/apps/report/color_map.hpp>
#include <facula/apps/report/drawing.hpp>
#include <facula/apps/report/number_format.hpp>
#include <facula/apps/report/text.hpp>
#include <facula/tests/support/matchers.hpp>

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace facula {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Relative luminance of an sRGB colour (WCAG 2, from IEC 61966-2-1).
double luminance(const Color& color) {
  double result = 0;
  const double weights[3] = {0.2126, 0.7152, 0.0722};
  for (std::size_t k = 0; k < 3; ++k) {
    const double c = color[k] / 255.0;
    result += weights[k] * (c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4));
  }
  return result;
}

/// How much ink of black drawing lies on white paper [px].
double ink(const Image8& canvas) {
  double sum = 0;
  for (const std::uint8_t value : canvas.pixels) sum += (255 - value) / 255.0;
  return sum / 3;
}

TEST(ColorMap, EndsWhereViridisEnds) {
  EXPECT_EQ(color_at(ColorMap::kViridis, 0), (Color{68, 1, 84}));
  EXPECT_EQ(color_at(ColorMap::kViridis, 1), (Color{253, 231, 37}));
  EXPECT_EQ(color_at(ColorMap::kViridis, -5), color_at(ColorMap::kViridis, 0));
  EXPECT_EQ(color_at(ColorMap::kViridis, kInfinity), color_at(ColorMap::kViridis, 1));
  EXPECT_EQ(color_at(ColorMap::kViridis, kNaN), kNoDataColor);
}

TEST(ColorMap, ViridisGrowsLighterAllTheWay) {
  for (int i = 0; i < 100; ++i) {
    EXPECT_LT(luminance(color_at(ColorMap::kViridis, i / 100.0)),
              luminance(color_at(ColorMap::kViridis, (i + 1) / 100.0)))
        << i;
  }
}

TEST(ColorMap, DivergingIsBlueBelowRedAboveAndLightestInTheMiddle) {
  const Color low = color_at(ColorMap::kDiverging, 0);
  const Color middle = color_at(ColorMap::kDiverging, 0.5);
  const Color high = color_at(ColorMap::kDiverging, 1);
  EXPECT_GT(low[2], low[0] + 80);
  EXPECT_GT(high[0], high[2] + 80);
  EXPECT_GT(luminance(middle), 0.9);
  for (const double t : {0.0, 0.2, 0.4, 0.6, 0.8, 1.0}) {
    EXPECT_LT(luminance(color_at(ColorMap::kDiverging, t)), luminance(middle)) << t;
  }
}

TEST(ColorBar, ShowsTheScaleFromBottomToTop) {
  const ColorScale scale{ColorMap::kViridis, 0, 10, "x [mm]"};
  const Image8 bar = color_bar(scale, 400);
  EXPECT_EQ(bar.rows, 400);
  const Color top = pixel_color(bar, 20, 54);
  const Color bottom = pixel_color(bar, 20, 400 - 14 - 3);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(top[k], scale.at(10)[k], 8);
    EXPECT_NEAR(bottom[k], scale.at(0)[k], 8);
  }
}

TEST(RobustRange, IgnoresAFewStraysAndValuesThatAreNotFinite) {
  std::vector<float> values;
  for (int i = 0; i <= 1000; ++i) values.push_back(static_cast<float>(i));
  values.push_back(1e9F);
  values.push_back(std::numeric_limits<float>::quiet_NaN());
  const ValueRange range = robust_range(values, 0.01);
  EXPECT_NEAR(range.low, 10, 1);
  EXPECT_NEAR(range.high, 991, 1);
  EXPECT_EQ(robust_range({}).high, 1);
  const ValueRange flat = robust_range({2, 2, 2});
  EXPECT_LT(flat.low, 2);
  EXPECT_GT(flat.high, 2);
}

TEST(Drawing, DiscHasTheAreaOfACircle) {
  Image8 canvas = make_canvas(100, 100);
  draw_disc(canvas, {49.7, 50.2}, 30, {0, 0, 0});
  EXPECT_NEAR(ink(canvas), M_PI * 900, 10);
}

TEST(Drawing, LineHasTheAreaOfItsLengthTimesItsWidth) {
  Image8 canvas = make_canvas(100, 100);
  draw_line(canvas, {10.3, 20.1}, {80.6, 70.4}, {{0, 0, 0}, 3});
  const double length = std::hypot(70.3, 50.3);
  EXPECT_NEAR(ink(canvas), length * 3 + M_PI * 2.25, 6);
}

TEST(Drawing, CutsOffWhatLiesOutside) {
  Image8 canvas = make_canvas(20, 20);
  draw_line(canvas, {-1e12, 5}, {1e12, 5}, {{0, 0, 0}, 1});
  EXPECT_EQ(pixel_color(canvas, 0, 5), (Color{0, 0, 0}));
  draw_disc(canvas, {1e9, -1e9}, 5, {0, 0, 0});
  draw_disc(canvas, {kNaN, 3}, 5, {0, 0, 0});
  draw_line(canvas, {kInfinity, 3}, {2, 2});
  draw_text(canvas, {-500, 400}, "outside");
  set_pixel(canvas, 20, 0, {0, 0, 0});
  fill_box(canvas, {-5, -5, 7, 7}, {0, 0, 0});
  EXPECT_EQ(pixel_color(canvas, 1, 1), (Color{0, 0, 0}));
  EXPECT_EQ(pixel_color(canvas, 2, 2), kPaper);
}

TEST(Drawing, JoinsPicturesWithoutChangingThem) {
  const Image8 red = make_canvas(4, 6, {255, 0, 0});
  const Image8 blue = make_canvas(8, 3, {0, 0, 255});
  const Image8 row = beside({red, blue}, 2);
  EXPECT_EQ(row.rows, 8);
  EXPECT_EQ(row.cols, 11);
  EXPECT_EQ(pixel_color(row, 5, 3), (Color{255, 0, 0}));
  EXPECT_EQ(pixel_color(row, 6, 0), kPaper);
  EXPECT_EQ(pixel_color(row, 8, 7), (Color{0, 0, 255}));
  const Image8 column = below({red, blue}, 1);
  EXPECT_EQ(column.rows, 13);
  EXPECT_EQ(column.cols, 6);
}

TEST(Drawing, RefusesACanvasWithoutSizeOrOfAbsurdSize) {
  EXPECT_FALSE(error_of([] { make_canvas(0, 10); }).empty());
  EXPECT_FALSE(error_of([] { make_canvas(10, 2000000000); }).empty());
}

TEST(Text, IsWrittenWhereItsAnchorSays) {
  for (const TextAlign align : {TextAlign::kLeft, TextAlign::kCenter, TextAlign::kRight}) {
    Image8 canvas = make_canvas(60, 400);
    draw_text(canvas, {200, 30}, "12.5 mm", {.size = 20, .color = {0, 0, 0}, .align = align});
    double sum = 0;
    double mean = 0;
    for (int y = 0; y < canvas.rows; ++y) {
      for (int x = 0; x < canvas.cols; ++x) {
        const double dark = 255 - pixel_color(canvas, x, y)[0];
        sum += dark;
        mean += dark * x;
      }
    }
    ASSERT_GT(sum, 0);
    const double half = text_width("12.5 mm", 20) / 2;
    const double shift = align == TextAlign::kLeft ? half : -half;
    EXPECT_NEAR(mean / sum, align == TextAlign::kCenter ? 200 : 200 + shift, 0.2 * half);
  }
}

TEST(Text, KnowsTheSignsOfUnits) {
  EXPECT_GT(text_width("µm", 20), text_width("m", 20));
  Image8 micro = make_canvas(40, 60);
  Image8 plain = make_canvas(40, 60);
  draw_text(micro, {10, 20}, "µ", {.color = {0, 0, 0}});
  draw_text(plain, {10, 20}, "u", {.color = {0, 0, 0}});
  EXPECT_GT(ink(micro), ink(plain) + 2);           // the tail
  draw_text(plain, {10, 20}, "\xFF\xFE\xC2", {});  // no UTF-8: question marks, no crash
}

TEST(NumberFormat, WritesFiguresAndUnits) {
  EXPECT_EQ(format_fixed(-0.0001, 2), "0.00");
  EXPECT_EQ(format_fixed(-12.345, 1), "-12.3");
  EXPECT_EQ(format_fixed(kNaN, 1), "n/a");
  EXPECT_EQ(format_significant(0.012345, 3), "0.0123");
  EXPECT_EQ(format_significant(9.996, 3), "10.0");
  EXPECT_EQ(format_significant(123456, 3), "123456");
  EXPECT_EQ(format_length(0.0123), "12.3 mm");
  EXPECT_EQ(format_length(-45.6e-6), "-45.6 µm");
  EXPECT_EQ(format_length(3.214), "3.21 m");
  EXPECT_EQ(format_count(1080000), "1 080 000");
  EXPECT_EQ(format_count(999), "999");
}

TEST(NumberFormat, TicksAreRoundAndInsideTheRange) {
  EXPECT_EQ(tick_labels(round_ticks(-0.03, 0.11, 5)),
            (std::vector<std::string>{"0.00", "0.05", "0.10"}));
  EXPECT_EQ(tick_labels(round_ticks(0, 1000, 4)), (std::vector<std::string>{"0", "500", "1000"}));
  EXPECT_TRUE(round_ticks(1, 1, 5).empty());
  EXPECT_TRUE(round_ticks(kNaN, 1, 5).empty());
  EXPECT_TRUE(round_ticks(0, kInfinity, 5).empty());
  EXPECT_LE(round_ticks(1e15, 1e15 + 0.25, 5).size(), 10U);
}

}  // namespace
}  // namespace facula
