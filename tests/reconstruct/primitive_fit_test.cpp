// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/random.hpp>
#include <facula/reconstruct/measure/cylinder.hpp>
#include <facula/reconstruct/measure/sphere.hpp>

#include <cmath>
#include <limits>
#include <numeric>

#include <Eigen/Dense>
#include <gtest/gtest.h>

namespace facula {
namespace {

const Eigen::Vector3d kSensor(0.05, -0.1, 0);

std::vector<std::size_t> all_of(const PointCloud& cloud) {
  std::vector<std::size_t> indices(cloud.size());
  std::iota(indices.begin(), indices.end(), std::size_t{0});
  return indices;
}

/// Adds a point of a surface as a scanner sees it: noise of sigma along the ray; only faces turned
/// to the sensor.
void see(PointCloud& cloud,
         const Eigen::Vector3d& x,
         const Eigen::Vector3d& normal,
         double sigma,
         Random& random) {
  const Eigen::Vector3d ray = (x - kSensor).normalized();
  if (ray.dot(normal) > -0.2) return;
  cloud.points.emplace_back((x + sigma * random.normal() * ray).cast<float>());
  cloud.normals.emplace_back(normal.cast<float>());
  cloud.sigma.push_back(static_cast<float>(sigma));
  cloud.sensor_origin.emplace_back(kSensor.cast<float>());
}

const Sphere kBall{{0.1, 0.2, 1.0}, 0.05};

PointCloud scanned_ball(int tries, std::uint64_t seed) {
  Random random(seed);
  PointCloud cloud;
  for (int i = 0; i < tries; ++i) {
    const Eigen::Vector3d n =
        Eigen::Vector3d(random.normal(), random.normal(), random.normal()).normalized();
    const double sigma = i % 2 == 0 ? 2e-4 : 8e-4;
    see(cloud, kBall.center + kBall.radius * n, n, sigma, random);
  }
  return cloud;
}

const Cylinder kRod{{-0.1, 0.05, 0.8}, Eigen::Vector3d(0.3, 0.9, 0.2).normalized(), 0.02};

PointCloud scanned_rod(int tries, std::uint64_t seed) {
  Random random(seed);
  PointCloud cloud;
  const Eigen::Vector3d u = kRod.axis.unitOrthogonal();
  const Eigen::Vector3d v = kRod.axis.cross(u);
  for (int i = 0; i < tries; ++i) {
    const double turn = 2 * M_PI * random.uniform();
    const Eigen::Vector3d n = std::cos(turn) * u + std::sin(turn) * v;
    const Eigen::Vector3d x =
        kRod.point + (0.2 * random.uniform() - 0.1) * kRod.axis + kRod.radius * n;
    see(cloud, x, n, i % 2 == 0 ? 1e-4 : 4e-4, random);
  }
  return cloud;
}

void add_clutter(PointCloud& cloud, int count, std::uint64_t seed) {
  Random random(seed);
  for (int i = 0; i < count; ++i) {
    cloud.points.emplace_back(static_cast<float>(random.uniform() - 0.5),
                              static_cast<float>(random.uniform() - 0.5),
                              static_cast<float>(0.5 + random.uniform()));
    const Eigen::Vector3d n(random.normal(), random.normal(), random.normal());
    cloud.normals.emplace_back(n.normalized().cast<float>());
    cloud.sigma.push_back(3e-4F);
    cloud.sensor_origin.emplace_back(kSensor.cast<float>());
  }
}

/// The mean of chi squared values with `freedom` degrees over `trials`, within 4 standard
/// deviations.
void expect_chi_squared_mean(double mean, int freedom, int trials) {
  EXPECT_NEAR(mean, freedom, 4 * std::sqrt(2.0 * freedom / trials));
}

TEST(SphereFit, CovarianceHoldsOverRepeatedScans) {
  constexpr int kTrials = 200;
  double mean = 0;
  for (int t = 0; t < kTrials; ++t) {
    const PointCloud cloud = scanned_ball(600, 10 + static_cast<std::uint64_t>(t));
    const SphereFit fit = fit_sphere(cloud, all_of(cloud));
    Eigen::Vector4d error;
    error << fit.sphere.center - kBall.center, fit.sphere.radius - kBall.radius;
    mean += error.dot(fit.quality.covariance.ldlt().solve(error)) / kTrials;
    EXPECT_NEAR(
        fit.quality.chi_squared / static_cast<double>(fit.quality.degrees_of_freedom), 1, 0.5);
  }
  expect_chi_squared_mean(mean, 4, kTrials);
}

TEST(CylinderFit, CovarianceHoldsOverRepeatedScans) {
  constexpr int kTrials = 200;
  double mean = 0;
  for (int t = 0; t < kTrials; ++t) {
    const PointCloud cloud = scanned_rod(600, 5000 + static_cast<std::uint64_t>(t));
    Cylinder start = kRod;
    start.point += Eigen::Vector3d(0.005, -0.003, 0.004);
    start.axis = (start.axis + Eigen::Vector3d(0.1, 0, -0.1)).normalized();
    start.radius = 0.03;
    const CylinderFit fit = fit_cylinder(cloud, all_of(cloud), start);
    const double side = fit.cylinder.axis.dot(kRod.axis) > 0 ? 1 : -1;
    const Eigen::Vector3d tilt = fit.cylinder.axis - side * kRod.axis;
    Eigen::Vector3d offset = fit.cylinder.point - kRod.point;
    offset -= offset.dot(kRod.axis) * kRod.axis;
    Eigen::VectorXd error(5);
    error << offset.dot(fit.axis_u), offset.dot(fit.axis_v), tilt.dot(fit.axis_u),
        tilt.dot(fit.axis_v), fit.cylinder.radius - kRod.radius;
    mean += error.dot(fit.quality.covariance.ldlt().solve(error)) / kTrials;
    EXPECT_NEAR(fit.length, 0.2, 0.01);
    EXPECT_LT(fit.covered, M_PI);
  }
  expect_chi_squared_mean(mean, 5, kTrials);
}

TEST(SphereFit, IsExactOnExactPointsAndWithoutSigma) {
  PointCloud cloud;
  for (int i = 0; i < 200; ++i) {
    const double a = 0.1 * i;
    cloud.points.emplace_back(
        Eigen::Vector3d(std::cos(a), std::sin(a), std::cos(3.3 * a)).normalized().cast<float>());
  }
  const SphereFit fit = fit_sphere(cloud, all_of(cloud));
  EXPECT_NEAR(fit.sphere.radius, 1, 1e-6);
  EXPECT_LT(fit.sphere.center.norm(), 1e-6);
  EXPECT_LT(fit.quality.rms, 1e-6);
  EXPECT_EQ(fit.quality.chi_squared, 0);
  cloud.points.resize(4);
  EXPECT_EQ(fit_sphere(cloud, {0, 1, 2, 3}).quality.degrees_of_freedom, 0U);
  EXPECT_TRUE(std::isnan(fit_sphere(cloud, {0, 1, 2, 3}).radius_sigma)) << "not known, not 0";
}

TEST(FindSphere, FindsTheBallAmongClutterAndRepeatsItself) {
  PointCloud cloud = scanned_ball(2000, 3);
  const std::size_t of_ball = cloud.size();
  add_clutter(cloud, 1500, 4);
  const ShapeSearchOptions options{.inlier_distance = 0.003, .max_radius = 0.2};
  const FoundSphere found = find_sphere(cloud, options);
  EXPECT_NEAR(found.fit.sphere.radius, kBall.radius, 2e-4);
  EXPECT_LT((found.fit.sphere.center - kBall.center).norm(), 3e-4);
  EXPECT_GT(found.indices.size(), 0.94 * static_cast<double>(of_ball));
  EXPECT_EQ(find_sphere(cloud, options).indices, found.indices);
}

TEST(FindCylinder, FindsTheRodAmongClutterAndRepeatsItself) {
  PointCloud cloud = scanned_rod(2000, 3);
  const std::size_t of_rod = cloud.size();
  add_clutter(cloud, 1500, 4);
  const ShapeSearchOptions options{.inlier_distance = 0.0015, .max_radius = 0.2, .trials = 1000};
  const FoundCylinder found = find_cylinder(cloud, options);
  EXPECT_NEAR(found.fit.cylinder.radius, kRod.radius, 2e-4);
  EXPECT_GT(std::abs(found.fit.cylinder.axis.dot(kRod.axis)), std::cos(0.01));
  EXPECT_GT(found.indices.size(), 0.9 * static_cast<double>(of_rod));
  EXPECT_EQ(find_cylinder(cloud, options).indices, found.indices);
}

TEST(PrimitiveFits, RefuseWhatDecidesNoShape) {
  PointCloud cloud;
  EXPECT_THROW(fit_sphere(cloud, {}), Error);
  EXPECT_THROW(find_sphere(cloud), Error);
  EXPECT_THROW(find_cylinder(cloud), Error);
  for (int i = 0; i < 100; ++i) {
    cloud.points.emplace_back(static_cast<float>(i % 10), static_cast<float>(i / 10), 1.F);
  }
  EXPECT_THROW(fit_sphere(cloud, all_of(cloud)), Error);  // a plane
  EXPECT_THROW(find_cylinder(cloud), Error);              // without normals
  EXPECT_THROW(fit_cylinder(cloud, all_of(cloud), {{0, 0, 0}, {0, 0, 0}, 1}), Error);
  EXPECT_THROW(fit_sphere(cloud, {0, 1, 2, 700}), Error);
  cloud.points.assign(100, Eigen::Vector3f(1, 2, 3));
  EXPECT_THROW(fit_sphere(cloud, all_of(cloud)), Error);
  cloud.normals.assign(100, Eigen::Vector3f::UnitZ());
  EXPECT_THROW(find_cylinder(cloud), Error);
  cloud.points.assign(100, Eigen::Vector3f(std::numeric_limits<float>::quiet_NaN(), 2, 3));
  EXPECT_THROW(find_sphere(cloud), Error);
  EXPECT_THROW(find_sphere(cloud, {.inlier_distance = 0}), Error);
}

}  // namespace
}  // namespace facula
