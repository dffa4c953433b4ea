// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/reconstruct/filter/normals.hpp>
#include <facula/tests/reconstruct/surfaces.hpp>
#include <facula/tests/support/matchers.hpp>

#include <algorithm>

#include <gtest/gtest.h>

namespace facula {
namespace {

double angle(const Eigen::Vector3f& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cast<double>().cross(b).norm(), a.cast<double>().dot(b));
}

TEST(EstimateNormals, PointsOnASphereLookAlongItsRadius) {
  PointCloud cloud = sphere_points(20000, 2.0);
  cloud.sensor_origin.resize(cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) cloud.sensor_origin[i] = 3 * cloud.points[i];
  estimate_normals(cloud);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    EXPECT_LT(angle(cloud.normals[i], cloud.points[i].cast<double>()), 0.01);
  }
}

TEST(EstimateNormals, FacesTheFramesOriginWhereNoSensorIsKnown) {
  PointCloud cloud = sphere_points(2000, 2.0);
  estimate_normals(cloud);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    EXPECT_LT(angle(cloud.normals[i], -cloud.points[i].cast<double>()), 0.05);
  }
}

TEST(EstimateNormals, IsExactOnATiltedPlaneFarFromTheOrigin) {
  const Patch patch{{100, 200, 50}, {1, 0, 0.5}, {0, 1, 0.25}};
  const Eigen::Vector3d truth = patch.side_u.cross(patch.side_v).normalized();
  PointCloud cloud;
  Random random(1);
  add_patch(cloud, patch, 3000, 0, random);
  cloud.sensor_origin.assign(cloud.size(), Eigen::Vector3f(100, 200, 90));
  estimate_normals(cloud);
  // Floats at 200 m step by 15 um, over neighbourhoods some 5 cm wide.
  for (const Eigen::Vector3f& n : cloud.normals) EXPECT_LT(angle(n, truth), 2e-3);
}

TEST(EstimateNormals, CopiesOfAPointCountOnce) {
  const PointCloud once = sphere_points(2000, 2.0);
  PointCloud cloud;
  for (int copy = 0; copy < 25; ++copy) {
    cloud.points.insert(cloud.points.end(), once.points.begin(), once.points.end());
  }
  estimate_normals(cloud);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    EXPECT_LT(angle(cloud.normals[i], -cloud.points[i].cast<double>()), 0.05);
  }
}

TEST(EstimateNormals, DoesNotDependOnTheNumberOfThreads) {
  PointCloud one = sphere_points(5000, 1.0);
  PointCloud four = one;
  estimate_normals(one, {.num_threads = 1});
  estimate_normals(four, {.num_threads = 4});
  EXPECT_EQ(one.normals, four.normals);
}

TEST(EstimateNormals, RefusesTooFewNeighboursOrPoints) {
  PointCloud cloud = sphere_points(100, 1.0);
  EXPECT_NE(error_of([&] { estimate_normals(cloud, {.neighbours = 2}); }), "");
  PointCloud two = sphere_points(2, 1.0);
  EXPECT_NE(error_of([&] { estimate_normals(two); }), "");
}

}  // namespace
}  // namespace facula
