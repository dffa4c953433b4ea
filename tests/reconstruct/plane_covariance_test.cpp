// SPDX-License-Identifier: GPL-3.0-or-later
// The covariance of a fitted plane against the spread of repeated fits.
#include <facula/acquire/core/random.hpp>
#include <facula/reconstruct/measure/plane.hpp>

#include <cmath>

#include <Eigen/Dense>
#include <gtest/gtest.h>

namespace facula {
namespace {

constexpr int kTrials = 1500;

/// Points of a slanting wall seen from the origin; the noise lies along the rays and grows tenfold
/// from one end to the other.
struct Wall {
  Plane truth{Eigen::Vector3d(0.5, 0.2, 1).normalized(), 1.7};
  std::vector<Eigen::Vector3d> points;
  std::vector<double> sigma;
  double rough = 0;      ///< of the wall along its normal, which no sigma knows [m]
  double too_small = 1;  ///< factor of the sigmas that points state

  explicit Wall(int count) {
    Random random(3);
    const Eigen::Vector3d u = truth.normal.unitOrthogonal();
    const Eigen::Vector3d v = truth.normal.cross(u);
    const Eigen::Vector3d middle = truth.distance * truth.normal + 0.3 * u - 0.4 * v;
    for (int i = 0; i < count; ++i) {
      const double s = 2 * random.uniform() - 1;
      points.emplace_back(middle + s * u + 0.4 * (random.uniform() - 0.5) * v);
      sigma.push_back(0.001 * std::pow(10, (1 + s) / 2));
    }
  }

  PointCloud seen(Random& random, double shared_error = 0) const {
    PointCloud cloud;
    for (std::size_t i = 0; i < points.size(); ++i) {
      double error = shared_error + sigma[i] * random.normal();
      if (rough > 0) error += rough * random.normal() / points[i].normalized().dot(truth.normal);
      cloud.points.emplace_back((points[i] + error * points[i].normalized()).cast<float>());
      cloud.sigma.push_back(static_cast<float>(sigma[i] / too_small));
    }
    return cloud;
  }
};

/// (a, b, h) that carry the fit to the true plane, to first order.
Eigen::Vector3d error_of_fit(const PlaneFit& fit, const Plane& truth) {
  return {truth.normal.dot(fit.axis_u),
          truth.normal.dot(fit.axis_v),
          -truth.signed_distance(fit.centroid)};
}

struct Spread {
  double distance = 0;     ///< mean of e' C^-1 e over 3: 1 when C is honest
  double inside = 0;       ///< share of trials with the distance of a far point within 2 sigma
  double far = 0;          ///< variance there [m^2]
  double chi = 0;          ///< mean of chi2 / degrees of freedom
  double unexplained = 0;  ///< mean [m]
};

Spread spread_of(const Wall& wall, const PlaneFitOptions& options) {
  Random random(11);
  const Eigen::Vector3d far = wall.points.front() + Eigen::Vector3d(0.4, 1, -0.4);
  Spread spread;
  for (int trial = 0; trial < kTrials; ++trial) {
    const PlaneFit fit = fit_plane(wall.seen(random), options);
    const Eigen::Vector3d e = error_of_fit(fit, wall.truth);
    spread.distance += e.dot(fit.covariance.inverse() * e) / 3 / kTrials;
    const double miss = fit.plane.signed_distance(far) - wall.truth.signed_distance(far);
    spread.inside += (std::abs(miss) <= 2 * fit.sigma_at(far) ? 1.0 : 0.0) / kTrials;
    spread.far += miss * miss / kTrials;
    spread.unexplained += fit.unexplained / kTrials;
    spread.chi += fit.chi_squared / double(fit.degrees_of_freedom) / kTrials;
  }
  // For docs/planes.md: --gtest_output=xml writes it down.
  testing::Test::RecordProperty(options.weigh_by_sigma ? "percent_inside" : "percent_inside_equal",
                                std::to_string(100 * spread.inside));
  return spread;
}

TEST(PlaneCovariance, IsHonestForUnequalNoiseAlongSlantingRays) {
  const Wall wall(120);
  for (const bool weigh : {true, false}) {
    const Spread spread = spread_of(wall, {.weigh_by_sigma = weigh});
    // Three squares of 1 500 trials: 1 +- 0.021, less what a misfit above 1 adds (3 % of it).
    EXPECT_NEAR(spread.distance, 0.97, 0.08) << weigh;
    EXPECT_NEAR(spread.inside, 0.955, 0.02) << weigh;
    EXPECT_NEAR(spread.chi, 1, weigh ? 0.02 : 0.2) << weigh;
  }
}

TEST(PlaneCovariance, ShrinksWhenPointsCountByTheirSigma) {
  const Wall wall(120);
  const Spread weighed = spread_of(wall, {.weigh_by_sigma = true});
  const Spread equal = spread_of(wall, {.weigh_by_sigma = false});
  EXPECT_LT(weighed.far, 0.6 * equal.far);
}

TEST(PlaneCovariance, IsHonestWhereSigmasLeaveSomethingUnexplained) {
  Wall wall(120);
  wall.rough = 0.01;
  for (const bool weigh : {true, false}) {
    const Spread spread = spread_of(wall, {.weigh_by_sigma = weigh});
    EXPECT_NEAR(spread.distance, 1, 0.08) << weigh;
    EXPECT_NEAR(spread.inside, 0.955, 0.02) << weigh;
    EXPECT_NEAR(spread.unexplained, wall.rough, 0.03 * wall.rough) << weigh;
    EXPECT_GT(spread.chi, 5) << weigh;
  }
}

TEST(PlaneCovariance, GrowsWhereAllSigmasAreTooSmall) {
  // A factor is not a sum: unequal sigmas that are all five times too small leave the plane a
  // little too sure, by an eighth of its sigma, not by five times.
  Wall wall(120);
  wall.too_small = 5;
  for (const bool weigh : {true, false}) {
    const Spread spread = spread_of(wall, {.weigh_by_sigma = weigh});
    EXPECT_GT(spread.inside, 0.9) << weigh;
    EXPECT_LT(spread.distance, 1.35) << weigh;
    EXPECT_NEAR(spread.chi, 25, weigh ? 8 : 5) << weigh;
  }
}

TEST(PlaneCovariance, LetsNoFewPointsThatClaimToBeSureDecideThePlane) {
  // A table of 1 m with 2 mm roughness, along whose edge five points 3 mm below state 1 um.
  Random random(2);
  PointCloud cloud;
  for (int i = 0; i < 500; ++i) {
    cloud.points.emplace_back(float(random.uniform() - 0.5),
                              float(random.uniform() - 0.5),
                              float(1 + 0.002 * random.normal()));
    cloud.sigma.push_back(5e-4F);
  }
  for (int i = 0; i < 5; ++i) {
    cloud.points.emplace_back(0.5F, 0.25F * float(i - 2), 0.997F);
    cloud.sigma.push_back(1e-6F);
  }
  const PlaneFit fit = fit_plane(cloud);
  EXPECT_NEAR(fit.plane.distance, 1, 4 * fit.distance_sigma);
  EXPECT_LT(fit.distance_sigma, 2e-4);
  EXPECT_NEAR(fit.plane.normal.x(), 0, 4 * fit.normal_sigma);
  EXPECT_LT(fit.normal_sigma, 5e-4);
  EXPECT_NEAR(fit.unexplained, 0.002, 2e-4);
}

TEST(PlaneCovariance, MovesWithThePointItIsGivenAt) {
  const Wall wall(60);
  Random random(6);
  const PlaneFit fit = fit_plane(wall.seen(random));
  EXPECT_TRUE(fit.covariance_at(fit.centroid).isApprox(fit.covariance));
  // Along the normal nothing changes; there and back neither.
  EXPECT_TRUE(fit.covariance_at(fit.centroid + 3 * fit.plane.normal).isApprox(fit.covariance));
  PlaneFit moved = fit;
  const Eigen::Vector3d there = fit.centroid + 2 * fit.axis_u - fit.axis_v;
  moved.centroid = there;
  moved.covariance = fit.covariance_at(there);
  EXPECT_TRUE(moved.covariance_at(fit.centroid).isApprox(fit.covariance, 1e-9));
  EXPECT_GT(fit.sigma_at(there), fit.distance_sigma);
}

TEST(PlaneCovariance, SaysHowThePlaneAnswersAnErrorThatAllRangesShare) {
  const Wall wall(200);
  Random random(8);
  Random again(8);
  constexpr double kShared = 1e-3;
  const PlaneFit before = fit_plane(wall.seen(random));
  const PlaneFit after = fit_plane(wall.seen(again, kShared));
  // The plane that was found, seen from the fit before: less e of one is more of the other.
  const Eigen::Vector3d moved = error_of_fit(before, after.plane);
  const Eigen::Vector3d told = kShared * before.range_response;
  EXPECT_NEAR(moved.x(), told.x(), 2e-6);
  EXPECT_NEAR(moved.y(), told.y(), 2e-6);
  EXPECT_NEAR(moved.z(), told.z(), 2e-6);
  EXPECT_GT(told.norm(), 5e-4);
}

TEST(PlaneCovariance, TakesUnknownSigmasForNone) {
  const Wall wall(80);
  Random random(4);
  PointCloud cloud = wall.seen(random);
  const PlaneFit weighed = fit_plane(cloud);
  PointCloud bare = cloud;
  bare.sigma.clear();
  const PlaneFit none = fit_plane(bare);
  for (const float unknown : {0.0F, -1.0F, INFINITY, NAN}) {
    cloud.sigma[5] = unknown;
    const PlaneFit fit = fit_plane(cloud);
    EXPECT_EQ(fit.plane.normal, none.plane.normal) << unknown;
    EXPECT_EQ(fit.covariance, none.covariance) << unknown;
    EXPECT_EQ(fit.chi_squared, 0) << unknown;
  }
  EXPECT_NE(weighed.plane.normal, none.plane.normal);
}

TEST(PlaneOutline, IsTheHullOnThePlaneWithItsArea) {
  PointCloud cloud;
  for (const float x : {0.0F, 1.0F, 2.0F}) {
    for (const float y : {0.0F, 0.5F, 1.0F}) cloud.points.emplace_back(x, y, 3 + 0 * x);
  }
  const PlaneFit fit = fit_plane(cloud);
  EXPECT_EQ(fit.outline.size(), 4U);
  EXPECT_NEAR(fit.area, 2, 1e-12);
  Eigen::Vector3d turn = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < fit.outline.size(); ++i) {
    const Eigen::Vector3d& next = fit.outline[(i + 1) % fit.outline.size()];
    turn += (fit.outline[i] - fit.centroid).cross(next - fit.centroid) / 2;
  }
  EXPECT_NEAR(turn.dot(fit.plane.normal), fit.area, 1e-12);
}

TEST(PlaneFitOfIndices, EqualsTheFitOfThosePoints) {
  const Wall wall(90);
  Random random(9);
  const PointCloud cloud = wall.seen(random);
  std::vector<std::size_t> odd;
  for (std::size_t i = 1; i < cloud.size(); i += 2) odd.push_back(i);
  const PlaneFit direct = fit_plane(cloud, odd);
  const PlaneFit copied = fit_plane(selected(cloud, odd));
  EXPECT_EQ(direct.plane.normal, copied.plane.normal);
  EXPECT_EQ(direct.covariance, copied.covariance);
  EXPECT_EQ(direct.points, 45U);
}

}  // namespace
}  // namespace facula
