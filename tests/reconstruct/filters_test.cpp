// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/random.hpp>
#include <facula/reconstruct/filter/filter_verdict.hpp>
#include <facula/reconstruct/filter/gate_filters.hpp>
#include <facula/reconstruct/filter/outlier_filters.hpp>
#include <facula/reconstruct/filter/smoothing.hpp>
#include <facula/tests/reconstruct/surfaces.hpp>
#include <facula/tests/support/matchers.hpp>

#include <cmath>

#include <gtest/gtest.h>

namespace facula {
namespace {

PointCloud points_of(const std::vector<Eigen::Vector3f>& points) {
  PointCloud cloud;
  cloud.points = points;
  return cloud;
}

TEST(FilterVerdict, KeepsTheFirstReasonAndCountsEach) {
  FilterVerdict verdict(4);
  verdict.remove(2, Removal::kMixed);
  verdict.remove(2, Removal::kRange);
  FilterVerdict next(3);  // on the points 0, 1 and 3
  next.remove(2, Removal::kRadius);
  add_verdict(verdict, next);
  EXPECT_EQ(
      verdict.reason,
      (std::vector<Removal>{Removal::kKept, Removal::kKept, Removal::kMixed, Removal::kRadius}));
  EXPECT_EQ(verdict.count(Removal::kMixed), 1U);
  EXPECT_EQ(verdict.count(Removal::kRange), 0U);
  EXPECT_EQ(verdict.removed(), 2U);
  EXPECT_EQ(verdict.kept(), (std::vector<std::size_t>{0, 1}));
  EXPECT_NE(error_of([&] { add_verdict(verdict, FilterVerdict(3)); }), "");
}

TEST(FilterVerdict, ClearsTheCellsOfAScan) {
  PolarScan scan = PolarScan::empty(2, 2);
  scan.set(1, {1, 0, 0}, 0.5F, 0.001F);
  scan.set(3, {2, 0, 0}, 0.5F, 0.001F);
  FilterVerdict verdict(2);
  verdict.remove(1, Removal::kMixed);
  clear_removed(scan, verdict);
  EXPECT_EQ(scan.valid, (std::vector<std::uint8_t>{0, 1, 0, 0}));
  EXPECT_NE(error_of([&] { clear_removed(scan, verdict); }), "");
}

TEST(FilterVerdict, CarriesTheGridAlong) {
  GriddedCloud scan{points_of({{0, 0, 1}, {0, 0, 2}, {0, 0, 3}}), {1, 3, {0, 1, 2}}};
  FilterVerdict verdict(3);
  verdict.remove(1, Removal::kRange);
  apply(scan, verdict);
  EXPECT_EQ(scan.cloud.size(), 2U);
  EXPECT_EQ(scan.grid.point, (std::vector<std::int32_t>{0, ScanGrid::kNone, 1}));
}

TEST(RadiusOutliers, CountOtherPointsWithinTheRadius) {
  // Three in a row 1 apart, one 5 away, one that is not finite.
  const auto cloud = points_of({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {7, 0, 0}, {NAN, 0, 0}});
  const auto one = radius_outliers(cloud, {.radius = 1, .min_neighbours = 1});
  EXPECT_EQ(one.kept(), (std::vector<std::size_t>{0, 1, 2}));
  EXPECT_EQ(one.count(Removal::kNotFinite), 1U);
  const auto two = radius_outliers(cloud, {.radius = 1, .min_neighbours = 2});
  EXPECT_EQ(two.kept(), (std::vector<std::size_t>{1}));
  EXPECT_EQ(radius_outliers(cloud, {.radius = 1, .min_neighbours = 9}).kept().size(), 0U);
  EXPECT_EQ(radius_outliers({}, {.radius = 1}).removed(), 0U);
  EXPECT_NE(error_of([&] { radius_outliers(cloud, {.radius = 0}); }), "");
}

TEST(OutsideRange, MeasuresFromEachPointsOrigin) {
  PointCloud cloud = points_of({{0, 0, 1}, {0, 0, 5}, {0, 0, 9}, {0, NAN, 0}});
  EXPECT_EQ(outside_range(cloud, {2, 6}).kept(), (std::vector<std::size_t>{1}));
  cloud.sensor_origin = {{0, 0, -2}, {0, 0, 4}, {0, 0, 4}, {0, 0, 0}};
  EXPECT_EQ(outside_range(cloud, {2, 6}).kept(), (std::vector<std::size_t>{0, 2}));
  EXPECT_NE(error_of([&] { outside_range(cloud, {2, 1}); }), "");
  EXPECT_NE(error_of([&] { outside_range(cloud, {-1, 1}); }), "");
}

TEST(OutsideHeight, MeasuresInTheWorld) {
  const PointCloud cloud = points_of({{0, 0, 1}, {0, 2, 1}, {0, -2, 1}, {0, 0, NAN}});
  EXPECT_EQ(outside_height(cloud, {0.5, 1.5}).kept(), (std::vector<std::size_t>{0, 1, 2}));
  // The scan's y is the world's z, 1 m up.
  RigidTransform world_from_scan;
  world_from_scan.rotation = Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitX());
  world_from_scan.translation = {0, 0, 1};
  const FilterVerdict verdict = outside_height(cloud, {.highest = 2}, world_from_scan);
  EXPECT_EQ(verdict.kept(), (std::vector<std::size_t>{0, 2}));
  EXPECT_EQ(verdict.count(Removal::kRange), 1U);
  EXPECT_EQ(verdict.count(Removal::kNotFinite), 1U);
  EXPECT_EQ(outside_height(cloud, {.lowest = 0}, world_from_scan).kept(),
            (std::vector<std::size_t>{0, 1}));
  EXPECT_NE(error_of([&] { outside_height(cloud, {2, 1}); }), "");
}

TEST(SteeperThan, JudgesTheAngleBetweenNormalAndRay) {
  PointCloud cloud = points_of({{0, 0, 1}, {0, 0, 1}, {0, 0, 1}});
  EXPECT_NE(error_of([&] { steeper_than(cloud, 1); }).find("normals"), std::string::npos);
  const auto tilted = [](double angle) {
    return Eigen::Vector3f(float(std::sin(angle)), 0, float(-std::cos(angle)));
  };
  cloud.normals = {tilted(0.9), tilted(1.1), Eigen::Vector3f::Zero()};
  EXPECT_EQ(steeper_than(cloud, 1).kept(), (std::vector<std::size_t>{0, 2}));
  EXPECT_EQ(steeper_than(cloud, 1).count(Removal::kIncidence), 1U);
  EXPECT_NE(error_of([&] { steeper_than(cloud, 2); }), "");
}

/// Points of z = bend (x^2 + y^2) / 2 with noise along z of a sigma that differs from point to
/// point, seen from far above.
PointCloud noisy_bowl(double bend, std::uint64_t seed) {
  Random random(seed);
  PointCloud cloud;
  for (int i = 0; i < 6000; ++i) {
    const double x = 2 * random.uniform() - 1;
    const double y = 2 * random.uniform() - 1;
    const double sigma = 0.002 * (1 + 4 * random.uniform());
    const double z = 0.5 * bend * (x * x + y * y) + sigma * random.normal();
    cloud.points.emplace_back(float(x), float(y), float(z));
    cloud.sigma.push_back(float(sigma));
    cloud.sensor_origin.emplace_back(float(x), float(y), 100);
  }
  return cloud;
}

/// Mean of (error / new sigma)^2 over the points well inside, and of the new sigma over the old.
std::pair<double, double> smoothed_errors(double bend, const SmoothingOptions& options) {
  double chi2 = 0;
  double ratio = 0;
  int count = 0;
  for (const std::uint64_t seed : {1, 2, 3}) {
    const PointCloud before = noisy_bowl(bend, seed);
    const SmoothedCloud after = smooth(before, options);
    for (std::size_t i = 0; i < before.size(); ++i) {
      const Eigen::Vector3d p = after.cloud.points[i].cast<double>();
      if (p.head<2>().cwiseAbs().maxCoeff() > 0.7) continue;
      const double error = p.z() - 0.5 * bend * p.head<2>().squaredNorm();
      chi2 += std::pow(error / after.cloud.sigma[i], 2);
      ratio += after.cloud.sigma[i] / before.sigma[i];
      ++count;
    }
  }
  return {chi2 / count, ratio / count};
}

TEST(Smooth, ReportsTheSigmaItReachesOnAPlane) {
  for (const int order : {1, 2}) {
    const auto [chi2, ratio] = smoothed_errors(0, {.radius = 0.06, .order = order});
    EXPECT_GT(chi2, 0.85) << "order " << order;
    EXPECT_LT(chi2, 1.15) << "order " << order;
    EXPECT_LT(ratio, 0.4) << "order " << order;
  }
}

TEST(Smooth, FollowsACurvedSurfaceWithTheSecondOrder) {
  const double bend = 0.5;  // a sphere of 2 m
  const auto second = smoothed_errors(bend, {.radius = 0.06, .order = 2});
  EXPECT_GT(second.first, 0.8);
  EXPECT_LT(second.first, 1.2);
  // A plane through the neighbours misses the bending by about bend * radius^2, over its sigma.
  const SmoothingOptions plane{.radius = 0.06, .order = 1, .max_misfit = 1e9};
  EXPECT_GT(smoothed_errors(2, plane).first, 2);
}

TEST(Smooth, DoesNotMovePointsAcrossAnEdge) {
  // A step of 0.3 along x = 0, fifty sigmas high.
  PointCloud cloud = noisy_bowl(0, 6);
  for (auto& p : cloud.points) p.z() += p.x() > 0 ? 0.3F : 0.0F;
  const SmoothedCloud after = smooth(cloud, {.radius = 0.06});
  double chi2 = 0;
  int count = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Eigen::Vector3f& p = after.cloud.points[i];
    if (p.head<2>().cwiseAbs().maxCoeff() > 0.9F) continue;
    chi2 += std::pow((p.z() - (cloud.points[i].x() > 0 ? 0.3F : 0.0F)) / after.cloud.sigma[i], 2);
    ++count;
  }
  EXPECT_LT(chi2 / count, 1.5);
  EXPECT_GT(after.moved, cloud.size() / 2);
}

TEST(Smooth, TakesTheNoiseFromTheScatterWithoutSigmas) {
  PointCloud cloud;
  Random random(5);
  for (int i = 0; i < 4000; ++i) {
    cloud.points.emplace_back(
        float(random.uniform()), float(random.uniform()), float(0.002 * random.normal()));
  }
  const SmoothedCloud after = smooth(cloud, {.radius = 0.05, .order = 1});
  double chi2 = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    chi2 += std::pow(after.cloud.points[i].z() / after.cloud.sigma[i], 2) / double(cloud.size());
  }
  EXPECT_GT(chi2, 0.8);
  EXPECT_LT(chi2, 1.3);
}

TEST(Smooth, TakesUnknownSigmasForNone) {
  PointCloud cloud = noisy_bowl(0, 7);
  PointCloud bare = cloud;
  bare.sigma.clear();
  cloud.sigma[17] = 0;
  const SmoothedCloud some = smooth(cloud, {.radius = 0.06});
  cloud.sigma.assign(cloud.size(), 0);
  const SmoothedCloud zeros = smooth(cloud, {.radius = 0.06});
  const SmoothedCloud none = smooth(bare, {.radius = 0.06});
  EXPECT_GT(none.moved, cloud.size() / 2);
  EXPECT_EQ(zeros.cloud.points, none.cloud.points);
  EXPECT_EQ(zeros.cloud.sigma, none.cloud.sigma);
  EXPECT_EQ(some.cloud.points, none.cloud.points);
}

TEST(Smooth, LeavesLonelyAndUnknownPointsAlone) {
  PointCloud cloud = points_of({{0, 0, 0}, {5, 0, 0}, {NAN, 0, 0}});
  const SmoothedCloud after = smooth(cloud, {.radius = 0.1});
  EXPECT_EQ(after.moved, 0U);
  EXPECT_EQ(after.cloud.points[1], cloud.points[1]);
  EXPECT_EQ(smooth({}, {.radius = 0.1}).moved, 0U);
  EXPECT_NE(error_of([&] { smooth(cloud, {.radius = 0}); }), "");
  EXPECT_NE(error_of([&] { smooth(cloud, {.radius = 1, .order = 3}); }), "");
}

TEST(Smooth, RefusesARadiusThatTakesInEverything) {
  PointCloud cloud;
  for (int i = 0; i < 6000; ++i) cloud.points.emplace_back(0.001F * float(i), 0.0F, 1.0F);
  const std::string said = error_of([&] { smooth(cloud, {.radius = 1e6}); });
  EXPECT_NE(said.find("give a smaller one"), std::string::npos) << said;
}

TEST(Smooth, BearsPointsThatSpanNoSurface) {
  PointCloud line;
  for (int i = 0; i < 50; ++i) line.points.emplace_back(0.01F * float(i), 0, 0);
  const SmoothedCloud after = smooth(line, {.radius = 0.1});
  EXPECT_EQ(after.moved, 0U);
  EXPECT_EQ(after.cloud.points, line.points);
  const PointCloud same = points_of(std::vector<Eigen::Vector3f>(50, {1, 2, 3}));
  for (const auto& p : smooth(same, {.radius = 0.1}).cloud.points) EXPECT_TRUE(p.allFinite());
}

TEST(Filters, AreTheSameForEveryNumberOfThreads) {
  const PointCloud cloud = noisy_bowl(0.5, 4);
  EXPECT_EQ(statistical_outliers(cloud, {.num_threads = 1}).reason,
            statistical_outliers(cloud, {.num_threads = 3}).reason);
  const SmoothedCloud one = smooth(cloud, {.radius = 0.06, .num_threads = 1});
  const SmoothedCloud three = smooth(cloud, {.radius = 0.06, .num_threads = 3});
  EXPECT_EQ(one.cloud.points, three.cloud.points);
  EXPECT_EQ(one.cloud.sigma, three.cloud.sigma);
}

}  // namespace
}  // namespace facula
