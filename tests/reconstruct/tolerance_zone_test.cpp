// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/random.hpp>
#include <facula/reconstruct/measure/bounding_rectangle.hpp>
#include <facula/reconstruct/measure/tolerance_zone.hpp>
#include <facula/tests/support/matchers.hpp>

#include <cmath>

#include <Eigen/Dense>
#include <gtest/gtest.h>

namespace facula {
namespace {

constexpr double kSigma = 0.001;

/// A rectangle of points about `middle` with sides u and v, with noise along its normal.
PointCloud rectangle(const Eigen::Vector3d& middle,
                     const Eigen::Vector3d& u,
                     const Eigen::Vector3d& v,
                     Random* random = nullptr) {
  PointCloud cloud;
  const Eigen::Vector3d normal = u.cross(v).normalized();
  for (int i = 0; i <= 8; ++i) {
    for (int k = 0; k <= 8; ++k) {
      const double noise = random != nullptr ? kSigma * random->normal() : 0;
      cloud.points.emplace_back(
          (middle + (i / 8.0 - 0.5) * u + (k / 8.0 - 0.5) * v + noise * normal).cast<float>());
    }
  }
  return cloud;
}

std::vector<Eigen::Vector3d> points_of(const PointCloud& cloud) {
  std::vector<Eigen::Vector3d> points;
  for (const Eigen::Vector3f& p : cloud.points) points.emplace_back(p.cast<double>());
  return points;
}

const Eigen::Vector3d kX(1, 0, 0);
const Eigen::Vector3d kY(0, 1, 0);
const Eigen::Vector3d kZ(0, 0, 1);

TEST(Parallelism, IsTheRiseOfATiltedSurfaceOverItsDatum) {
  const PlaneFit datum = fit_plane(rectangle({0, 0, 1}, kX, kY));
  const PointCloud tilted = rectangle({0, 0, 2}, 2 * kX + 0.01 * kZ, 0.5 * kY + 0.002 * kZ);
  const ToleranceZone zone = parallelism(fit_plane(tilted), datum, points_of(tilted));
  EXPECT_NEAR(zone.plane.value, 0.012, 1e-6);
  EXPECT_NEAR(zone.points, 0.012, 1e-6);
}

TEST(Parallelism, OfPointsHoldsFormAsWell) {
  const PlaneFit datum = fit_plane(rectangle({0, 0, 1}, kX, kY));
  PointCloud bump = rectangle({0, 0, 2}, kX, kY);
  for (Eigen::Vector3f& p : bump.points) {
    p.z() += std::abs(p.x()) < 0.3F && std::abs(p.y()) < 0.3F ? 0.02F : 0.0F;
  }
  const ToleranceZone zone = parallelism(fit_plane(bump), datum, points_of(bump));
  EXPECT_NEAR(zone.points, 0.02, 1e-6);
  EXPECT_NEAR(zone.plane.value, 0, 1e-6);
}

TEST(Perpendicularity, IsTheLeanOverTheHeightAndIgnoresTurnsAboutTheDatum) {
  const PlaneFit datum = fit_plane(rectangle({0, 0, 0}, kX, kY));
  for (const double turn : {0.0, 0.4, 2.0}) {
    const Eigen::AngleAxisd about(turn, kZ);
    const PointCloud wall = rectangle({2, 1, 1}, about * (1.5 * kX), about * (2 * kZ + 0.03 * kY));
    const ToleranceZone zone = perpendicularity(fit_plane(wall), datum, points_of(wall));
    EXPECT_NEAR(zone.plane.value, 0.03, 1e-5) << turn;
    EXPECT_NEAR(zone.points, 0.03, 1e-5) << turn;
  }
}

TEST(Perpendicularity, OfPointsIsTheNarrowestStripOverAllDirections) {
  Random random(4);
  const PlaneFit datum = fit_plane(rectangle({0, 0, 0}, kX, kY));
  const PointCloud wall = rectangle({2, 1, 1}, kX, 2 * kZ + 0.01 * kY, &random);
  const auto points = points_of(wall);
  const double zone = perpendicularity(fit_plane(wall), datum, points).points;
  double least = INFINITY;
  for (double turn = 0; turn < M_PI; turn += 1e-4) {  // brute force
    const Eigen::Vector3d m(std::cos(turn), std::sin(turn), 0);
    double low = INFINITY;
    double high = -INFINITY;
    for (const Eigen::Vector3d& p : points) {
      low = std::min(low, m.dot(p));
      high = std::max(high, m.dot(p));
    }
    least = std::min(least, high - low);
  }
  EXPECT_LE(zone, least + 1e-12);
  EXPECT_NEAR(zone, least, 1e-4);
}

TEST(ToleranceZone, OfThePlaneIsCoveredByItsUncertainty) {
  constexpr int kTrials = 1500;
  Random random(8);
  double inside_parallel = 0;
  double inside_square = 0;
  double inside_flat = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    const PlaneFit datum = fit_plane(rectangle({0, 0, 0}, kX, 0.7 * kY, &random));
    const auto share = [](const Measured& m, double truth) {
      return (std::abs(m.value - truth) <= 2 * m.sigma ? 1.0 : 0.0) / kTrials;
    };
    const auto tilted = fit_plane(rectangle({0, 0, 1}, kX + 0.006 * kZ, 0.5 * kY, &random));
    inside_parallel += share(parallelism(tilted, datum, {}).plane, 0.006);
    const auto flat = fit_plane(rectangle({0, 0, 1}, kX, 0.5 * kY, &random));
    inside_flat += share(parallelism(flat, datum, {}).plane, 0);
    const auto wall = fit_plane(rectangle({0, 1, 1}, kX, kZ + 0.004 * kY, &random));
    inside_square += share(perpendicularity(wall, datum, {}).plane, 0.004);
  }
  // The corner that rises most is chosen after the fact, so the tilted surface is a little less
  // covered than 95.4 %; parallel ones are on the safe side by the wider rule.
  EXPECT_NEAR(inside_parallel, 0.95, 0.03);
  EXPECT_NEAR(inside_square, 0.954, 0.02);
  EXPECT_GE(inside_flat, 0.92);
}

TEST(SmallestWidth, HasTheClosedFormsOfPolygons) {
  EXPECT_NEAR(smallest_width({{0, 0}, {3, 0}, {3, 2}, {0, 2}}), 2, 1e-15);
  EXPECT_NEAR(smallest_width({{0, 0}, {4, 0}, {0, 3}}), 2.4, 1e-15);
  EXPECT_EQ(smallest_width({{0, 0}, {1, 1}}), 0);
  EXPECT_EQ(smallest_width({}), 0);
}

TEST(ToleranceZone, RefusesPlanesThatStandOtherwise) {
  const PlaneFit floor = fit_plane(rectangle({0, 0, 0}, kX, kY));
  const PlaneFit wall = fit_plane(rectangle({1, 0, 0}, kZ, kY));
  EXPECT_NE(error_of([&] { parallelism(wall, floor, {}); }).find("parallelism"), std::string::npos);
  EXPECT_NE(error_of([&] { perpendicularity(floor, floor, {}); }), "");
  EXPECT_NE(error_of([&] { parallelism({}, floor, {}); }).find("outline"), std::string::npos);
}

}  // namespace
}  // namespace facula
