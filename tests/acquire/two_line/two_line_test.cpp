// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/random.hpp>
#include <facula/acquire/two_line/two_line_fit.hpp>
#include <facula/acquire/two_line/two_line_frame.hpp>
#include <facula/tests/support/matchers.hpp>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace facula {
namespace {

// Tank distances of source E [m].
const std::vector<double> kTank = {0.61, 1.529, 2.14, 3.058, 3.975};

Rig two_line_rig(double medium_index = 1) {
  Rig rig;
  rig.camera = {.width = 640, .height = 480, .fx = 700, .fy = 700, .cx = 321, .cy = 238.5};
  rig.camera.k1 = -0.15;
  rig.camera.k2 = 0.03;
  rig.stripe_direction = StripeDirection::kPerColumn;
  rig.two_line = TwoLineHead{.spacing = 0.2, .divergence = 0, .medium_index = medium_index};
  return rig;
}

/// Refraction of a ray that leaves the window: from its direction in the medium to that in air.
Eigen::Vector2d into_air(const Eigen::Vector2d& in_medium, double index) {
  const double sine = index * std::sin(std::atan(in_medium.norm()));
  return in_medium.normalized() * std::tan(std::asin(sine));
}

/// Row in which the line of the sheet Y = y is seen on a wall z = depth + slope * X, in column u.
double row_of_line(const Rig& rig, double y, double depth, double slope, int u) {
  double low = -2;
  double high = 2;
  Eigen::Vector2d pixel;
  for (int i = 0; i < 60; ++i) {  // bisection along the line
    const double x = 0.5 * (low + high);
    const double z = depth / (1 - slope * x);
    const Eigen::Vector2d ray = into_air({x, y / z}, rig.two_line->medium_index);
    pixel = rig.camera.project({ray.x(), ray.y(), 1});
    (pixel.x() < u ? low : high) = x;
  }
  return pixel.y();
}

/// Two level Gaussian lines on a wall, with noise; half of `spacing` above and below the camera.
Image8 frame_of_wall(const Rig& rig, double depth, double slope, std::uint64_t seed) {
  Random random(seed);
  Image8 frame(rig.camera.height, rig.camera.width);
  for (int u = 0; u < frame.cols; ++u) {
    const double upper = row_of_line(rig, -0.1, depth, slope, u);
    const double lower = row_of_line(rig, 0.1, depth, slope, u);
    for (int v = 0; v < frame.rows; ++v) {
      const auto line = [&](double row) {
        return 180 * std::exp(-0.5 * std::pow((v - row) / 1.8, 2));
      };
      const double value = 12 + line(upper) + line(lower) + 2 * random.normal();
      frame.row(v)[u] = static_cast<std::uint8_t>(std::clamp(std::lround(value), 0L, 255L));
    }
  }
  return frame;
}

double depth_at(double depth, double slope, double angle) {
  return depth / (1 - slope * std::tan(angle));
}

struct Errors {
  double rms_share = 0;  ///< of the distance
  double worst_share = 0;
  double chi_square = 0;  ///< reduced
};

Errors errors_in_the_tank(const Rig& rig, TwoLineMethod method, double slope) {
  TwoLineOptions options;
  options.method = method;
  options.stripe.channel = Channel::kGrey;
  Errors errors;
  int count = 0;
  for (const double tank : kTank) {
    const Image8 frame = frame_of_wall(rig, tank, slope, static_cast<std::uint64_t>(1000 * tank));
    for (const TwoLineReading& r : read_two_lines(frame.view(), {}, rig, options)) {
      EXPECT_EQ(r.failure, "") << tank;
      if (!r.depth) continue;
      const double truth = depth_at(tank, slope, r.angle);
      const double share = (*r.depth - truth) / truth;
      errors.rms_share += share * share;
      errors.worst_share = std::max(errors.worst_share, std::abs(share));
      errors.chi_square += std::pow((*r.depth - truth) / r.sigma, 2);
      ++count;
    }
  }
  errors.rms_share = std::sqrt(errors.rms_share / count);
  errors.chi_square /= count;
  return errors;
}

TEST(TwoLineHead, IsEquationFourAndItsError) {
  const TwoLineHead head{.spacing = 0.2};
  EXPECT_DOUBLE_EQ(head.depth(0.1).value_or(0), 2.0);
  EXPECT_DOUBLE_EQ(head.separation(2.0), 0.1);
  EXPECT_FALSE(head.depth(0).has_value());
  EXPECT_FALSE(head.depth(-0.1).has_value());
  // (11) against the difference it stands for.
  const double by_difference = head.depth(0.1 - 1e-6).value_or(0) - head.depth(0.1).value_or(0);
  EXPECT_NEAR(head.depth_error(2.0, 1e-6) / by_difference, 1, 1e-4);
  EXPECT_NE(error_of([] { TwoLineHead{}.check(); }).find("above 0 mm"), std::string::npos);
  EXPECT_NE(error_of([] {
              TwoLineHead{0.1, 0, 0.5}.check();
            }).find("refractive"),
            std::string::npos);
}

TEST(TwoLineHead, RefractsByTheLawOfSines) {
  const TwoLineHead head{.spacing = 0.2, .divergence = 0, .medium_index = 1.33};
  for (const double t : {0.0, 0.01, 0.2, 0.5}) {
    const Eigen::Vector2d in_medium = head.in_medium({0.6 * t, 0.8 * t});
    const double in_air = std::sin(std::atan(t));
    EXPECT_NEAR(std::sin(std::atan(in_medium.norm())) * 1.33, in_air, 1e-15);
  }
}

TEST(FitTwoLine, RecoversSpacingAndDrift) {
  for (const double divergence : {0.0, 0.004}) {
    const TwoLineHead truth{.spacing = 0.2, .divergence = divergence};
    std::vector<TwoLinePoint> points;
    for (const double d : kTank) points.push_back({truth.separation(d), d});
    const TwoLineFit fit = fit_two_line(points);
    EXPECT_NEAR(fit.head.spacing, 0.2, 1e-9);
    EXPECT_NEAR(fit.head.divergence, divergence, 1e-9);
    EXPECT_LT(fit.held_out_rms, 1e-6);
  }
}

TEST(FitTwoLine, SaysThatSheetsAreNotParallel) {
  Random random(3);
  const TwoLineHead truth{.spacing = 0.2, .divergence = 0.004};
  std::vector<TwoLinePoint> points;
  for (const double d : kTank) points.push_back({truth.separation(d) + 2e-5 * random.normal(), d});
  const TwoLineFit fit = fit_two_line(points);
  EXPECT_NEAR(fit.head.divergence, 0.004, 5 * fit.divergence_sigma);
  EXPECT_GT(fit.parallel_held_out_rms, 5 * fit.held_out_rms);
  ASSERT_FALSE(fit.warnings.empty());
  EXPECT_NE(fit.warnings.back().find("not parallel"), std::string::npos);
}

TEST(FitTwoLine, TakesTwoDistancesMeasuredTwice) {
  const TwoLineFit fit = fit_two_line({{0.1, 2}, {0.1, 2}, {0.05, 4}, {0.05, 4}});
  EXPECT_NEAR(fit.head.spacing, 0.2, 1e-12);
  EXPECT_EQ(fit.head.divergence, 0);
}

TEST(FitTwoLine, RefusesWhatCannotBe) {
  const auto said = [](const std::vector<TwoLinePoint>& points) {
    return error_of([&] { fit_two_line(points); });
  };
  EXPECT_NE(said({{0.1, 2}}).find("two or more distances"), std::string::npos);
  EXPECT_NE(said({{0.1, 2}, {-0.1, 3}}).find("above 0"), std::string::npos);
  EXPECT_NE(said({{0.1, 1}, {0.2, 2}, {0.3, 3}, {0.4, 4}}).find("grow with the distance"),
            std::string::npos);
  EXPECT_NE(said({{0.1, 1}, {0.2, 2}}).find("grow with the distance"), std::string::npos);
  EXPECT_NE(said({{0.1, 1}, {0.1, 2}, {0.1, 3}}).find("stay the same"), std::string::npos);
  EXPECT_NE(said({{0.1, 1}, {std::nan(""), 2}}).find("finite"), std::string::npos);
}

/// Source E states 10 % up to 5 m; the aim is 1 % up to 4 m. The Hough way of the source is printed
/// beside the stripes' in docs/range_models.md.
TEST(ReadTwoLines, MeasuresTheTankToATenthOfAPerCentInAirAndWater) {
  for (const double index : {1.0, 1.33}) {
    const Rig rig = two_line_rig(index);
    for (const double slope : {0.0, 0.3}) {
      const Errors stripes = errors_in_the_tank(rig, TwoLineMethod::kStripes, slope);
      const Errors hough = errors_in_the_tank(rig, TwoLineMethod::kHough, slope);
      RecordProperty("stripes_rms_percent", std::to_string(100 * stripes.rms_share));
      RecordProperty("hough_rms_percent", std::to_string(100 * hough.rms_share));
      EXPECT_LT(stripes.worst_share, 0.002);
      EXPECT_LT(stripes.rms_share, 0.001);
      EXPECT_LT(hough.rms_share, 0.02);
      EXPECT_LT(stripes.rms_share, 0.5 * hough.rms_share);
      EXPECT_GT(stripes.chi_square, 0.5);
      EXPECT_LT(stripes.chi_square, 1.6);
    }
  }
}

/// What the source warns of: a camera calibrated in air and used in water without saying so.
TEST(ReadTwoLines, IsWrongByTheIndexWhenTheMediumIsForgotten) {
  const Rig water = two_line_rig(1.33);
  const Image8 frame = frame_of_wall(water, 2.14, 0, 5);
  Rig forgetful = water;
  forgetful.two_line->medium_index = 1;
  TwoLineOptions options;
  options.stripe.channel = Channel::kGrey;
  const auto readings = read_two_lines(frame.view(), {}, forgetful, options);
  ASSERT_TRUE(readings[3].depth.has_value());
  EXPECT_NEAR(2.14 / readings[3].depth.value_or(0), 1.33, 0.005);
}

TEST(ReadTwoLines, SaysWhichLineIsMissing) {
  const Rig rig = two_line_rig();
  Image8 frame = frame_of_wall(rig, 2.14, 0, 5);
  TwoLineOptions options;
  options.stripe.channel = Channel::kGrey;
  for (int v = 240; v < 480; ++v) std::fill_n(frame.row(v), 640, std::uint8_t{12});
  for (const TwoLineMethod method : {TwoLineMethod::kStripes, TwoLineMethod::kHough}) {
    options.method = method;
    for (const TwoLineReading& r : read_two_lines(frame.view(), {}, rig, options)) {
      EXPECT_EQ(r.failure, "no line below the camera's axis");
      EXPECT_FALSE(r.depth.has_value());
    }
  }
  options.segments = 20;
  EXPECT_NE(error_of([&] { read_two_lines(frame.view(), {}, rig, options); }).find("within"),
            std::string::npos);
  Rig plain = rig;
  plain.two_line.reset();
  EXPECT_NE(error_of([&] { read_two_lines(frame.view(), {}, plain, {}); }).find("[two_line]"),
            std::string::npos);
}

}  // namespace
}  // namespace facula
