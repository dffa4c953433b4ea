// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/known_sigma.hpp>
#include <facula/acquire/core/point_cloud.hpp>
#include <facula/tests/support/matchers.hpp>

#include <limits>
#include <numbers>

namespace facula {
namespace {

PointCloud three_points() {
  PointCloud cloud;
  cloud.points = {{1, 0, 0}, {0, 2, 0}, {0, 0, 3}};
  cloud.normals = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  cloud.colors = {{1, 2, 3}, {4, 5, 6}, {7, 8, 9}};
  cloud.intensity = {0.1F, 0.2F, 0.3F};
  cloud.sigma = {1e-3F, 2e-3F, 3e-3F};
  cloud.sensor_origin = {{0, 0, 1}, {0, 0, 2}, {0, 0, 3}};
  return cloud;
}

TEST(PointCloud, TurnsNormalsButMovesPointsAndOrigins) {
  RigidTransform quarter_turn;
  quarter_turn.rotation = Eigen::AngleAxisd(std::numbers::pi / 2, Eigen::Vector3d::UnitZ());
  quarter_turn.translation = {10, 0, 0};
  const PointCloud moved = transformed(three_points(), quarter_turn);
  EXPECT_TRUE(is_near_point(moved.points[0].cast<double>(), {10, 1, 0}, 1e-6));
  EXPECT_TRUE(is_near_point(moved.normals[0].cast<double>(), {0, 1, 0}, 1e-6));
  EXPECT_TRUE(is_near_point(moved.sensor_origin[1].cast<double>(), {10, 0, 2}, 1e-6));
  EXPECT_EQ(moved.colors, three_points().colors);
  EXPECT_EQ(moved.sigma, three_points().sigma);
}

TEST(PointCloud, SelectsPointsWithTheirAttributesInOrder) {
  const PointCloud some = selected(three_points(), {2, 0, 2});
  some.check();
  ASSERT_EQ(some.size(), 3U);
  EXPECT_EQ(some.points[0], three_points().points[2]);
  EXPECT_EQ(some.colors[1], three_points().colors[0]);
  EXPECT_EQ(some.intensity[2], 0.3F);
}

TEST(PointCloud, AppendDropsAttributesThatOneSideLacks) {
  PointCloud cloud = three_points();
  PointCloud more = three_points();
  more.normals.clear();
  append(cloud, more);
  cloud.check();
  EXPECT_EQ(cloud.size(), 6U);
  EXPECT_TRUE(cloud.normals.empty());
  EXPECT_EQ(cloud.colors.size(), 6U);
  PointCloud nothing;
  append(nothing, more);
  EXPECT_EQ(nothing.points, more.points);
  append(nothing, PointCloud());
  EXPECT_EQ(nothing.sigma, more.sigma);
}

TEST(PointCloud, CheckNamesTheAttributeOfTheWrongLength) {
  PointCloud cloud = three_points();
  EXPECT_NO_THROW(cloud.check());
  cloud.sigma.pop_back();
  EXPECT_NE(error_of([&] { cloud.check(); }).find("sigmas have 2"), std::string::npos);
}

TEST(PointCloud, TakesTheValidCellsOfAScanColumnByColumn) {
  PolarScan scan = PolarScan::empty(2, 2);
  scan.sensor_origin = {{1, 1, 1}, {2, 2, 2}};
  scan.set(scan.index(1, 0), {5, 0, 0}, 0.25F, 1e-3F);
  scan.set(scan.index(0, 1), {6, 0, 0}, 0.75F, 2e-3F);
  std::vector<std::size_t> cells{99};
  const PointCloud cloud = cloud_from_scan(scan, &cells);
  cloud.check();
  ASSERT_EQ(cloud.size(), 2U);
  EXPECT_EQ(cells, (std::vector<std::size_t>{1, 2}));
  EXPECT_EQ(cloud.points[1], Eigen::Vector3f(6, 0, 0));
  EXPECT_EQ(cloud.intensity[0], 0.25F);
  EXPECT_EQ(cloud.sigma[1], 2e-3F);
  EXPECT_EQ(cloud.sensor_origin[1], Eigen::Vector3f(2, 2, 2));
}

TEST(KnownSigma, IsNeitherZeroNorBelowNorInfinite) {
  EXPECT_TRUE(is_known_sigma(1e-9));
  const double infinity = std::numeric_limits<double>::infinity();
  for (const double sigma : {0.0, -0.001, infinity, -infinity, std::nan("")}) {
    EXPECT_FALSE(is_known_sigma(sigma)) << sigma;
  }
}

TEST(KnownSigma, IsAskedOfEveryFinitePoint) {
  PointCloud cloud = three_points();
  EXPECT_TRUE(knows_sigma(cloud));
  cloud.sigma[1] = 0;
  EXPECT_FALSE(knows_sigma(cloud));
  cloud.points[1].x() = std::numeric_limits<float>::quiet_NaN();
  EXPECT_TRUE(knows_sigma(cloud));
  cloud.sigma.clear();
  EXPECT_FALSE(knows_sigma(cloud));
}

}  // namespace
}  // namespace facula
