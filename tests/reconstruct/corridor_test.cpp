// SPDX-License-Identifier: GPL-3.0-or-later
// Three scans of a corridor by a nodding laser (set range/3dtk-dat), whose notes give the distance
// of the walls and how far independent estimates of the poses lie apart.
#include <facula/reconstruct/filter/cloud_filters.hpp>
#include <facula/reconstruct/filter/normals.hpp>
#include <facula/reconstruct/measure/plane.hpp>
#include <facula/reconstruct/register/register_scans.hpp>
#include <facula/tests/support/matchers.hpp>
#include <facula/tests/support/real_data.hpp>

#include <gtest/gtest.h>

namespace facula {
namespace {

constexpr double kDegree = M_PI / 180;

/// The upright planes that look along y (our y is the file's -x, across the corridor).
std::vector<PlaneFit> side_walls(const std::vector<ExtractedPlane>& planes) {
  std::vector<PlaneFit> walls;
  for (const ExtractedPlane& plane : planes) {
    if (std::abs(plane.fit.plane.normal.y()) > 0.97) walls.push_back(plane.fit);
  }
  return walls;
}

TEST(Corridor, IsReadInMetresWithZUpAndWithoutRangesThatAreNoMeasurement) {
  FACULA_REQUIRE_REAL_DATA(folder, "range/3dtk-dat");
  const ScanProject project = read_scan_project(folder);
  ASSERT_EQ(project.scans.size(), 3U);
  EXPECT_EQ(project.scans[0].name, "scan000");
  EXPECT_NEAR(double(project.scans[0].cloud.size()), 77700, 100);
  EXPECT_EQ(project.scans[0].cloud.sensor_origin.size(), project.scans[0].cloud.size());
  // scan001.pose: -3.10605 -7.50803 156.917 cm is 1.57 m ahead.
  EXPECT_TRUE(is_near_point(
      project.scans[1].world_from_scan.translation, {1.56917, 0.0310605, -0.0750803}, 1e-9));
}

TEST(Corridor, WallsAreParallelAndAsFarApartAsKnown) {
  FACULA_REQUIRE_REAL_DATA(folder, "range/3dtk-dat");
  // The laser's noise is 1 cm, so 3 cm holds a wall together.
  PointCloud cloud = thin_by_voxel(read_scan_project(folder).scans[0].cloud, 0.05);
  estimate_normals(cloud);
  const auto planes = extract_planes(cloud, {.inlier_distance = 0.03});
  const auto walls = side_walls(planes);
  ASSERT_GE(walls.size(), 2U);
  EXPECT_LT(angle_between(walls[0].plane, walls[1].plane), 0.5 * kDegree);
  EXPECT_NEAR(distance_between(walls[0], walls[1]), 4.75, 0.03);
}

TEST(Corridor, RegistersNearThePosesOfItsMakers) {
  FACULA_REQUIRE_REAL_DATA(folder, "range/3dtk-dat");
  ScanProject project = read_scan_project(folder);
  const ScanProject given = project;
  const RegisterScansResult result = register_scans(project);
  EXPECT_TRUE(result.from_given);
  EXPECT_EQ(result.placed, 3U);
  for (const ScanPlacement& scan : result.scans) EXPECT_GT(scan.overlap, 0.4) << scan.reason;
  // Their own estimates lie 0.1 to 0.7 degrees and 1 to 6 cm (1), 1 to 2 degrees and 9 to 13 cm (2)
  // from a careful ICP, by the notes of the set.
  EXPECT_TRUE(is_near_pose(
      project.scans[1].world_from_scan, given.scans[1].world_from_scan, 0.7 * kDegree, 0.06));
  EXPECT_TRUE(is_near_pose(
      project.scans[2].world_from_scan, given.scans[2].world_from_scan, 2 * kDegree, 0.15));
}

}  // namespace
}  // namespace facula
