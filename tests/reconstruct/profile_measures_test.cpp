// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/random.hpp>
#include <facula/reconstruct/measure/profile_circle.hpp>
#include <facula/reconstruct/measure/profile_measures.hpp>
#include <facula/reconstruct/measure/profile_pieces.hpp>
#include <facula/reconstruct/measure/profile_section.hpp>
#include <facula/tests/support/matchers.hpp>

#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

namespace facula {
namespace {

const double kNan = std::numeric_limits<double>::quiet_NaN();

using Profile = std::vector<Eigen::Vector2d>;

/// Height over `across` [m], 0.1 mm from point to point, with noise in height.
template <typename Height>
Profile seen(double from, double to, const Height& height, double sigma, std::uint64_t seed) {
  Random random(seed);
  Profile profile;
  for (double x = from; x < to; x += 1e-4) {
    profile.emplace_back(x, height(x) + sigma * random.normal());
  }
  return profile;
}

/// Steps of 3.3 mm after source D, table I: ground, then one, two and three disks.
double stairs(double x) {
  return x < 0 ? 0 : 0.0033 * std::min(3.0, std::floor(x / 0.02) + 1);
}

/// The upper half of a regular hexagon of the given side, which lies on one side on the ground.
double hexagon(double x, double side) {
  const double a = std::abs(x);
  const double height = std::sqrt(3.0) * side;
  if (a <= side / 2) return height;
  if (a <= side) return height - (a - side / 2) * std::sqrt(3.0);
  return 0;
}

/// Source D, table II: the side follows from the height; the paper multiplies by ratios of two
/// digits.
TEST(PolygonSide, IsThatOfTheRegularPolygonOfThisHeight) {
  for (int sides = 3; sides <= 12; ++sides) {
    double lowest = HUGE_VAL;
    double highest = -HUGE_VAL;
    const double turn = 2 * std::numbers::pi / sides;
    for (int i = 0; i < sides; ++i) {  // a side below: corners half a step beside the lowest point
      const double y = -std::cos((i + 0.5) * turn);
      lowest = std::min(lowest, y);
      highest = std::max(highest, y);
    }
    const double side = 2 * std::sin(0.5 * turn);
    EXPECT_NEAR(polygon_side(sides, highest - lowest), side, 1e-12) << sides;
  }
  EXPECT_NEAR(polygon_ratio(5), 0.65, 0.005);
  EXPECT_NEAR(polygon_ratio(6), 0.58, 0.005);
  EXPECT_NEAR(polygon_ratio(8), 0.41, 0.005);
  EXPECT_NEAR(polygon_side(5, 38.78), 25.20, 0.005);
  EXPECT_NEAR(polygon_side(6, 38.96), 22.49, 0.005);  // printed 22.60 with the ratio 0.58
  EXPECT_NEAR(polygon_side(8, 40.72), 16.87, 0.005);  // printed 16.70 with the ratio 0.41
  EXPECT_NE(error_of([] { polygon_ratio(2); }).find("at least 3 sides"), std::string::npos);
  EXPECT_NE(error_of([] { polygon_side(5, 0); }).find("above 0 mm"), std::string::npos);
}

TEST(MeasureStep, RefusesSpansWithoutPoints) {
  std::vector<Eigen::Vector2d> profile(20, Eigen::Vector2d(kNan, kNan));
  for (int i = 0; i < 10; ++i) profile[static_cast<std::size_t>(i)] = {0.001 * i, 0};
  EXPECT_NE(error_of([&] {
              measure_step(profile, {0, 10}, {10, 20});
            }).find("on the top"),
            std::string::npos);
  EXPECT_NE(error_of([&] {
              measure_step(profile, {0, 40}, {10, 20});
            }).find("leave the profile"),
            std::string::npos);
}

TEST(StraightPieces, OfStairsAreTheirLevels) {
  const Profile profile = seen(-0.02, 0.06, stairs, 3e-5, 1);
  const auto pieces = straight_pieces(profile);
  ASSERT_EQ(pieces.size(), 4U);
  const auto base = base_piece(pieces);
  ASSERT_EQ(base, 0U);
  for (std::size_t i = 1; i < 4; ++i) {
    const StepMeasure step = step_between(profile, pieces[0], pieces[i]);
    EXPECT_NEAR(step.thickness, 0.0033 * static_cast<double>(i), 4 * step.sigma);
    EXPECT_LT(step.sigma, 3e-5);
    EXPECT_NEAR(pieces[i].scatter, 3e-5, 6e-6);
  }
}

TEST(StraightPieces, StepsHoldTheirSigma) {
  double mean = 0;
  constexpr int kTrials = 200;
  for (int t = 0; t < kTrials; ++t) {
    const Profile profile = seen(-0.02, 0.06, stairs, 3e-5, 100 + static_cast<std::uint64_t>(t));
    const auto pieces = straight_pieces(profile);
    ASSERT_EQ(pieces.size(), 4U) << t;
    const StepMeasure step = step_between(profile, pieces[0], pieces[2]);
    mean += std::pow((step.thickness - 0.0066) / step.sigma, 2) / kTrials;
  }
  EXPECT_NEAR(mean, 1, 0.4);  // 4 standard deviations of the mean of 200
}

TEST(SideLength, OfAHexagonIsItsSideWithItsSigma) {
  constexpr double kSide = 0.02252;
  double mean = 0;
  int measured = 0;
  for (int t = 0; t < 200; ++t) {
    const Profile profile = seen(
        -0.04,
        0.04,
        [](double x) { return hexagon(x, kSide); },
        3e-5,
        700 + static_cast<std::uint64_t>(t));
    const auto pieces = straight_pieces(profile);
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      if (std::abs(pieces[i].middle.x()) > 0.002) continue;
      const auto side = side_length(profile, pieces, i, 0.001);
      ASSERT_TRUE(side) << t;
      EXPECT_NEAR(side->value, kSide, 5e-5);
      mean += std::pow((side->value - kSide) / side->sigma, 2);
      ++measured;
    }
  }
  EXPECT_EQ(measured, 200);
  EXPECT_NEAR(mean / 200, 1, 0.5);
}

TEST(SideLength, IsNothingBesideAGap) {
  Profile profile = seen(
      -0.04, 0.04, [](double x) { return hexagon(x, 0.02); }, 1e-6, 2);
  std::erase_if(profile, [](const Eigen::Vector2d& p) { return p.x() > 0.006 && p.x() < 0.02; });
  const auto pieces = straight_pieces(profile);
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    if (std::abs(pieces[i].middle.x()) > 0.004 || pieces[i].middle.y() < 0.01) continue;
    EXPECT_FALSE(side_length(profile, pieces, i, 0.001));
  }
}

TEST(CutSection, LaysTheSliceFlat) {
  PointCloud cloud;
  for (int i = 0; i < 100; ++i) {
    cloud.points.emplace_back(
        0.1F * static_cast<float>(i % 10), 0.01F * static_cast<float>(i), 0.5F);
    cloud.sigma.push_back(0.001F * static_cast<float>(i));
  }
  cloud.points[5].x() = std::numeric_limits<float>::quiet_NaN();
  const ProfileSection section = cut_section(
      cloud, {.point = {0.3, 0, 0.2}, .normal = {5, 0, 0}, .up = {0.1, 0, 2}, .thickness = 0.02});
  ASSERT_EQ(section.points.size(), 10U);
  for (std::size_t i = 0; i < section.points.size(); ++i) {
    EXPECT_NEAR(section.points[i].y(), 0.3, 1e-6);
    EXPECT_NEAR(section.points[i].x(), cloud.points[section.indices[i]].y(), 1e-6);
    EXPECT_NEAR(section.sigma[i], cloud.sigma[section.indices[i]], 1e-9);
    EXPECT_GE(section.points[i].x(), section.points[i > 0 ? i - 1 : 0].x());
  }
}

TEST(FitCircle, GivesARodsDiameterWithItsSigma) {
  constexpr double kRadius = 0.0125;
  double mean = 0;
  constexpr int kTrials = 200;
  for (int t = 0; t < kTrials; ++t) {
    Random random(50 + static_cast<std::uint64_t>(t));
    ProfileSection section;
    for (double turn = -1; turn <= 1; turn += 0.01) {  // the part a scanner above sees
      const double radius = kRadius + 3e-5 * random.normal();
      section.points.emplace_back(3 + radius * std::sin(turn), 2 + radius * std::cos(turn));
      section.sigma.push_back(3e-5);
    }
    const CircleFit fit = fit_circle(section);
    EXPECT_NEAR(fit.radius, kRadius, 6 * fit.radius_sigma);
    mean += std::pow((fit.radius - kRadius) / fit.radius_sigma, 2) / kTrials;
  }
  EXPECT_NEAR(mean, 1, 0.4);
}

TEST(Profiles, RefuseWhatSaysNothing) {
  EXPECT_NE(error_of([] { cut_section({}, {}); }), "");
  PointCloud cloud;
  cloud.points.assign(3, Eigen::Vector3f(9, 9, 9));
  EXPECT_NE(error_of([&] { cut_section(cloud, {}); }).find("move the section"), std::string::npos);
  EXPECT_NE(error_of([&] {
              cut_section(cloud, {.up = {3, 0, 0}});
            }).find("parallel"),
            std::string::npos);
  EXPECT_NE(error_of([&] { cut_section(cloud, {.thickness = 0}); }), "");
  EXPECT_NE(error_of([] { fit_circle({}); }), "");
  EXPECT_NE(error_of([] { fit_circle({{{0, 0}, {1, 1}, {2, 2}, {5, 5}}, {}, {}}); }), "");
  EXPECT_NE(error_of([] { fit_circle({{{1, 1}, {1, 1}, {1, 1}}, {}, {}}); }), "");
  EXPECT_NE(error_of([] { straight_pieces({{0, kNan}, {1, 1}}); }), "");
  EXPECT_NE(error_of([] { straight_pieces({}, {.min_points = 2}); }), "");
  EXPECT_TRUE(straight_pieces({}).empty());
  EXPECT_TRUE(straight_pieces(Profile(4)).empty());
  EXPECT_FALSE(base_piece({}));
  EXPECT_FALSE(side_length({}, {}, 0, 1));
}

}  // namespace
}  // namespace facula
