// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/random.hpp>
#include <facula/apps/report/deviation_histogram.hpp>
#include <facula/apps/report/plane_deviation.hpp>
#include <facula/apps/report/plot_axes.hpp>
#include <facula/tests/support/matchers.hpp>

#include <limits>

#include <gtest/gtest.h>

namespace facula {
namespace {

/// 0.4 m x 0.2 m in the plane z = 1; the half with x > 0 lies 1 mm above, the other 1 mm below.
struct Step {
  PointCloud cloud;
  ExtractedPlane plane;
};

Step step_plate() {
  Step step;
  for (int i = 0; i < 200; ++i) {
    for (int k = 0; k < 100; ++k) {
      const double x = (i + 0.5) / 500 - 0.2;
      const double y = (k + 0.5) / 500 - 0.1;
      step.plane.indices.push_back(step.cloud.size());
      step.cloud.points.emplace_back(Eigen::Vector3d(x, y, x > 0 ? 1.001 : 0.999).cast<float>());
    }
  }
  step.plane.fit.plane = {Eigen::Vector3d::UnitZ(), 1.0};
  step.plane.fit.centroid = {0, 0, 1};
  step.plane.fit.rms = 1e-3;
  return step;
}

bool is_red(const Color& color) {
  return color[0] > color[2] + 60;
}
bool is_blue(const Color& color) {
  return color[2] > color[0] + 60;
}

TEST(PlaneDeviation, IsRedAboveThePlaneAndBlueBelow) {
  const Step step = step_plate();
  const Image8 picture = plane_deviation(step.plane, step.cloud);
  // u runs along x, the longer side; v along y. The lower left of the map is below the plane.
  const int y = kPlotMargin.y + 100;
  EXPECT_TRUE(is_blue(pixel_color(picture, kPlotMargin.x + 20, y)));
  EXPECT_TRUE(is_red(pixel_color(picture, kPlotMargin.x + 600, y)));
}

TEST(PlaneDeviation, TurnsWithTheNormal) {
  Step step = step_plate();
  step.plane.fit.plane = {-Eigen::Vector3d::UnitZ(), -1.0};
  const Image8 picture = plane_deviation(step.plane, step.cloud);
  EXPECT_TRUE(is_red(pixel_color(picture, kPlotMargin.x + 20, kPlotMargin.y + 100)));
}

TEST(PlaneDeviation, RefusesAForeignCloud) {
  Step step = step_plate();
  step.cloud.points.resize(10);
  EXPECT_NE(error_of([&] { plane_deviation(step.plane, step.cloud); }).find("10 points"),
            std::string::npos);
}

TEST(PlaneDeviation, SurvivesPlanesOfAnyKind) {
  Step step = step_plate();
  ExtractedPlane empty;
  EXPECT_EQ(plane_deviation(empty, step.cloud).rows, 160);
  step.plane.indices = {0};
  EXPECT_GT(plane_deviation(step.plane, step.cloud).rows, 160);  // one point
  step.plane.indices = {0, 1, 2, 3};                             // a line
  EXPECT_GT(plane_deviation(step.plane, step.cloud).rows, 160);
  for (Eigen::Vector3f& point : step.cloud.points) point.z() = 1;
  step.plane.fit.rms = 0;
  EXPECT_GT(plane_deviation(step.plane, step.cloud).rows, 160);  // no deviation at all
  step.cloud.points.assign(step.cloud.size(),
                           Eigen::Vector3f::Constant(std::numeric_limits<float>::quiet_NaN()));
  EXPECT_EQ(plane_deviation(step.plane, step.cloud).rows, 160);
}

TEST(DeviationHistogram, StandsWhereTheValuesAre) {
  // All values at +0.5 mm on an axis from -1.25 mm to 1.25 mm: the bar of 10 px that 70 % of the
  // width falls into.
  const std::vector<float> values(100, 0.5e-3F);
  const Image8 picture = deviation_histogram(values, {.largest = 1e-3, .width = 640});
  const int y = kPlotMargin.y + 200;
  EXPECT_NE(pixel_color(picture, kPlotMargin.x + 444, y), kPaper);
  EXPECT_EQ(pixel_color(picture, kPlotMargin.x + 640 * 3 / 10, y), kPaper);
}

TEST(DeviationHistogram, DrawsTheNormalCurveOverNormalValues) {
  // The curve's peak over bars of normal values: both reach the same height within the noise.
  Random random(3);
  std::vector<float> values;
  values.reserve(100000);
  for (int i = 0; i < 100000; ++i) values.push_back(static_cast<float>(1e-4 * random.normal()));
  const DeviationHistogramOptions bars_only{.largest = 3e-4};
  DeviationHistogramOptions with_curve = bars_only;
  with_curve.sigma = 1e-4;
  const auto highest_ink = [](const Image8& picture) {
    const int x = kPlotMargin.x + 320 + 4;
    int y = kPlotMargin.y + 1;
    while (pixel_color(picture, x, y) == kPaper) ++y;
    return y;
  };
  const int bars = highest_ink(deviation_histogram(values, bars_only));
  const int curve = highest_ink(deviation_histogram(values, with_curve));
  EXPECT_NEAR(bars, curve, 8);
}

TEST(DeviationHistogram, ChecksItsOptions) {
  EXPECT_FALSE(error_of([] { deviation_histogram({}, {.largest = 0}); }).empty());
}

}  // namespace
}  // namespace facula
