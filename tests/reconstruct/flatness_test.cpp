// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/random.hpp>
#include <facula/reconstruct/measure/flatness.hpp>
#include <facula/reconstruct/measure/flatness_uncertainty.hpp>

#include <cmath>
#include <limits>
#include <numeric>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace facula {
namespace {

std::vector<std::size_t> all_of(const PointCloud& cloud) {
  std::vector<std::size_t> indices(cloud.size());
  std::iota(indices.begin(), indices.end(), std::size_t{0});
  return indices;
}

/// A grid of points of size 1 m on z = height(x, y), plus noise.
template <typename Height>
PointCloud surface(int side, const Height& height, double sigma, std::uint64_t seed) {
  Random random(seed);
  PointCloud cloud;
  for (int row = 0; row < side; ++row) {
    for (int col = 0; col < side; ++col) {
      const double x = static_cast<double>(col) / (side - 1) - 0.5;
      const double y = static_cast<double>(row) / (side - 1) - 0.5;
      cloud.points.emplace_back(
          Eigen::Vector3d(x, y, height(x, y) + sigma * random.normal()).cast<float>());
      cloud.sigma.push_back(static_cast<float>(sigma));
    }
  }
  if (sigma == 0) cloud.sigma.clear();
  return cloud;
}

double flat(double, double) {
  return 1;
}

TEST(Flatness, OfABowlIsItsDepth) {
  const PointCloud cloud = surface(
      101, [](double x, double y) { return 1 + 4e-3 * (x * x + y * y); }, 0, 1);
  const Flatness flatness = measure_flatness(cloud);
  EXPECT_NEAR(flatness.total, 2e-3, 1e-6);
  EXPECT_NEAR(flatness.total, flatness.peak + flatness.valley, 1e-15);
  // The mean of 4e-3 (x^2 + y^2) over the square is 4e-3 / 6, over this grid 1 % more.
  EXPECT_NEAR(flatness.valley, 4e-3 / 6, 2e-5);
  // Its variance is 2 (4e-3)^2 / 180.
  EXPECT_NEAR(flatness.root_mean_square, 4e-3 * std::sqrt(2.0 / 180), 2e-5);
  EXPECT_EQ(flatness.valley_point, 50U * 101 + 50);
  ASSERT_TRUE(flatness.minimum_zone);
  EXPECT_NEAR(flatness.minimum_zone->total, 2e-3, 1e-6);
}

TEST(Flatness, MinimumZoneOfATwistIsNarrowerThanLeastSquares) {
  // A ridge off the middle tilts the least-squares plane; the zone is not led astray.
  const PointCloud cloud = surface(
      61, [](double x, double) { return 1 + (x > 0.3 ? 1e-2 * (x - 0.3) : 0); }, 0, 1);
  const Flatness flatness = measure_flatness(cloud);
  ASSERT_TRUE(flatness.minimum_zone);
  EXPECT_LT(flatness.minimum_zone->total, 0.9 * flatness.total);
  // In the section the hull is a triangle (-0.5, 0), (0.3, 0), (0.5, 2e-3): its least height is
  // that over the longest side.
  const double area = 0.5 * 0.8 * 2e-3;
  EXPECT_NEAR(flatness.minimum_zone->total, 2 * area / std::hypot(1, 2e-3), 2e-5);
  for (const Eigen::Vector3f& p : cloud.points) {
    EXPECT_LE(std::abs(flatness.minimum_zone->plane.signed_distance(p.cast<double>())),
              flatness.minimum_zone->total / 2 + 1e-12);
  }
}

TEST(Flatness, CountsPeaksTowardsTheSensor) {
  PointCloud cloud = surface(
      21, [](double x, double y) { return 1 + (x == 0 && y == 0 ? 5e-3 : 0); }, 0, 1);
  EXPECT_GT(measure_flatness(cloud).peak, 4e-3);
  cloud.sensor_origin.assign(cloud.size(), Eigen::Vector3f(0, 0, -2));
  EXPECT_GT(measure_flatness(cloud).valley, 4e-3);
  cloud.sensor_origin.assign(cloud.size(), Eigen::Vector3f(0, 0, 4));
  EXPECT_GT(measure_flatness(cloud).peak, 4e-3);
}

TEST(Flatness, DoesNotDependOnPoseThreadsOrDeadPoints) {
  PointCloud cloud = surface(150, flat, 1e-3, 4);
  const Flatness one = measure_flatness(cloud, FlatnessOptions{.num_threads = 1});
  const Flatness two = measure_flatness(cloud, FlatnessOptions{.num_threads = 2});
  EXPECT_EQ(one.total, two.total);
  EXPECT_EQ(one.root_mean_square, two.root_mean_square);
  EXPECT_EQ(one.minimum_zone->total, two.minimum_zone->total);
  RigidTransform turned;
  turned.rotation = Eigen::Quaterniond(0.3, -0.5, 0.7, 0.1).normalized();
  turned.translation = {3, -2, 1};
  const Flatness moved = measure_flatness(transformed(cloud, turned));
  EXPECT_NEAR(moved.total, one.total, 2e-6);  // the points are floats
  EXPECT_NEAR(moved.minimum_zone->total, one.minimum_zone->total, 2e-6);
  cloud.points.emplace_back(std::numeric_limits<float>::quiet_NaN(), 0.F, 0.F);
  cloud.sigma.push_back(1);
  EXPECT_EQ(measure_flatness(cloud).total, one.total);
}

TEST(Flatness, RefusesWhatHasNoPlane) {
  PointCloud cloud;
  EXPECT_THROW(measure_flatness(cloud), Error);
  cloud.points.assign(1, Eigen::Vector3f(1, 2, 3));
  EXPECT_THROW(measure_flatness(cloud), Error);
  cloud.points.assign(50, Eigen::Vector3f(1, 2, 3));
  EXPECT_THROW(measure_flatness(cloud), Error);
  for (int i = 0; i < 50; ++i) cloud.points[static_cast<std::size_t>(i)] *= static_cast<float>(i);
  EXPECT_THROW(measure_flatness(cloud), Error);
  EXPECT_THROW(measure_flatness(cloud, std::vector<std::size_t>{0, 1, 99}), Error);
}

TEST(FlatnessUncertainty, FloorHoldsFlatSurfacesAsOftenAsItSays) {
  int held = 0;
  double sum = 0;
  double floor = 0;
  constexpr int kScans = 200;
  for (int scan = 0; scan < kScans; ++scan) {
    const PointCloud cloud = surface(20, flat, 1e-3, 100 + static_cast<std::uint64_t>(scan));
    const Flatness flatness = measure_flatness(cloud, FlatnessOptions{.minimum_zone = false});
    const FlatnessUncertainty u = flatness_uncertainty(cloud, all_of(cloud), flatness);
    held += flatness.total <= u.floor_p95 ? 1 : 0;
    sum += flatness.total / kScans;
    floor += u.floor_mean / kScans;
    EXPECT_NEAR(u.sigma_points, 1e-3, 1e-7);
    EXPECT_GT(u.total_growth, 0);
  }
  EXPECT_GE(held, 180);  // 190 expected, standard deviation 3
  EXPECT_LE(held, 199);
  EXPECT_NEAR(sum, floor, 0.02 * sum);
}

TEST(FlatnessUncertainty, IsTheSpreadOfRepeatedScansOfABentPlate) {
  const auto bent = [](double x, double) { return 1 + 0.02 * x * x; };  // 5 mm, noise 0.1 mm
  std::vector<double> totals;
  double told = 0;
  constexpr int kScans = 300;
  for (int scan = 0; scan < kScans; ++scan) {
    const PointCloud cloud = surface(25, bent, 1e-4, 900 + static_cast<std::uint64_t>(scan));
    const Flatness flatness = measure_flatness(cloud, FlatnessOptions{.minimum_zone = false});
    totals.push_back(flatness.total);
    if (scan % 10 == 0) {
      told += flatness_uncertainty(cloud, all_of(cloud), flatness).total_sigma / (kScans / 10.0);
    }
  }
  const double mean = std::accumulate(totals.begin(), totals.end(), 0.0) / kScans;
  double squares = 0;
  for (const double total : totals) squares += (total - mean) * (total - mean);
  const double spread = std::sqrt(squares / (kScans - 1));
  EXPECT_GT(told, 0.85 * spread);
  EXPECT_LT(told, 1.5 * spread);  // the measured points are noisy already
  EXPECT_GT(mean, 5e-3 + 1e-4);   // noise raises it: the bias the header speaks of
}

TEST(FlatnessUncertainty, RepeatsItselfAndAsksForSigmas) {
  PointCloud cloud = surface(20, flat, 1e-3, 5);
  const Flatness flatness = measure_flatness(cloud);
  const auto first = flatness_uncertainty(cloud, all_of(cloud), flatness, {.num_threads = 1});
  const auto second = flatness_uncertainty(cloud, all_of(cloud), flatness, {.num_threads = 2});
  EXPECT_EQ(first.total_sigma, second.total_sigma);
  EXPECT_EQ(first.floor_p95, second.floor_p95);
  cloud.sigma.clear();
  EXPECT_THROW(flatness_uncertainty(cloud, all_of(cloud), flatness), Error);
  EXPECT_NEAR(flatness_uncertainty(cloud, all_of(cloud), flatness, {.sigma = 1e-3}).floor_mean,
              first.floor_mean,
              1e-9);
  EXPECT_THROW(flatness_uncertainty(cloud, all_of(cloud), flatness, {.sigma = -1}), Error);
  EXPECT_THROW(flatness_uncertainty(cloud, all_of(cloud), flatness, {.sigma = 1, .trials = 1}),
               Error);
}

}  // namespace
}  // namespace facula
