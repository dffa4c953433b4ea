// SPDX-License-Identifier: GPL-3.0-or-later
// Planes grown over the grid of a scan of a known room.
#include <facula/acquire/core/random.hpp>
#include <facula/reconstruct/filter/grid_normals.hpp>
#include <facula/reconstruct/measure/plane.hpp>
#include <facula/tests/support/matchers.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace facula {
namespace {

constexpr double kDegree = M_PI / 180;

struct GridScan {
  PointCloud cloud;
  ScanGrid grid;
};

const std::vector<Plane> kWalls = {{Eigen::Vector3d(1, 0, 0), 2},
                                   {Eigen::Vector3d(0, 1, 0), 1.5},
                                   {Eigen::Vector3d(0, -1, 0), 1.8},
                                   {Eigen::Vector3d(0, 0, 1), 1.2},
                                   {Eigen::Vector3d(0, 0, -1), 1.3}};

/// Rows of rays from the origin that end at the first wall, with noise along them; every 50th is
/// lost. `ball` puts a ball of that radius before the far wall.
GridScan scan_room(double sigma, double ball = 0) {
  GridScan scan{{}, {121, 161, {}}};
  Random random(41);
  for (int col = 0; col < scan.grid.cols; ++col) {
    for (int row = 0; row < scan.grid.rows; ++row) {
      const double yaw = (col - 80) * kDegree;
      const double pitch = (row - 60) * kDegree;
      const Eigen::Vector3d ray(
          std::cos(pitch) * std::cos(yaw), std::cos(pitch) * std::sin(yaw), std::sin(pitch));
      double range = INFINITY;
      for (const Plane& wall : kWalls) {
        const double cosine = wall.normal.dot(ray);
        if (cosine > 0) range = std::min(range, wall.distance / cosine);
      }
      const Eigen::Vector3d centre(1.4, 0, 0);
      const double along = centre.dot(ray);
      const double inside = ball * ball - (centre - along * ray).squaredNorm();
      if (inside > 0) range = along - std::sqrt(inside);
      const bool lost = random.below(50) == 0;
      scan.grid.point.push_back(lost ? ScanGrid::kNone
                                     : static_cast<std::int32_t>(scan.cloud.size()));
      if (lost) continue;
      scan.cloud.points.emplace_back(((range + sigma * random.normal()) * ray).cast<float>());
    }
  }
  scan.cloud.sensor_origin.assign(scan.cloud.size(), Eigen::Vector3f::Zero());
  scan.cloud.normals = grid_normals(scan.cloud, scan.grid);
  return scan;
}

void expect_walls(const std::vector<ExtractedPlane>& planes) {
  EXPECT_EQ(planes.size(), kWalls.size());
  for (const Plane& wall : kWalls) {
    bool found = false;
    for (const ExtractedPlane& plane : planes) {
      found = found || (plane.fit.plane.normal.dot(wall.normal) > std::cos(0.1 * kDegree) &&
                        std::abs(plane.fit.plane.distance - wall.distance) < 0.001);
    }
    EXPECT_TRUE(found) << wall.normal.transpose();
  }
}

TEST(GrowPlanes, FindsTheWallsThatTheScanSees) {
  const GridScan scan = scan_room(0.002);
  expect_walls(grow_planes(scan.cloud, scan.grid, {.min_points = 300}));
}

TEST(GrowPlanes, KeepsTheLargestWhereThereAreMore) {
  const GridScan scan = scan_room(0.002);
  for (int most = 1; most < 5; ++most) {
    const auto planes = grow_planes(scan.cloud, scan.grid, {.min_points = 300, .max_planes = most});
    ASSERT_EQ(planes.size(), static_cast<std::size_t>(most));
    // No wall that is missing is larger than one that was found, but for points at its edges.
    std::ptrdiff_t least_found = std::numeric_limits<std::ptrdiff_t>::max();
    std::ptrdiff_t most_missed = 0;
    for (const Plane& wall : kWalls) {
      const auto seen =
          std::count_if(scan.cloud.points.begin(), scan.cloud.points.end(), [&](const auto& p) {
            return std::abs(wall.signed_distance(p.template cast<double>())) < 0.01;
          });
      const bool found = std::any_of(planes.begin(), planes.end(), [&](const auto& plane) {
        return plane.fit.plane.normal.dot(wall.normal) > 0.99;
      });
      if (found) least_found = std::min(least_found, seen);
      if (!found) most_missed = std::max(most_missed, seen);
    }
    EXPECT_GT(double(least_found), 0.9 * double(most_missed)) << most;
  }
}

TEST(GrowPlanes, AgreesWithRansac) {
  const GridScan scan = scan_room(0.002);
  expect_walls(extract_planes(scan.cloud, {.min_points = 300}));
}

TEST(GrowPlanes, LeavesABallAlone) {
  const GridScan scan = scan_room(0.001, 0.4);
  expect_walls(grow_planes(scan.cloud, scan.grid, {.min_points = 300}));
}

TEST(GrowPlanes, IsTheSameForAnyNumberOfThreads) {
  const GridScan scan = scan_room(0.003);
  const auto one = grow_planes(scan.cloud, scan.grid, {.num_threads = 1});
  const auto two = grow_planes(scan.cloud, scan.grid, {.num_threads = 2});
  ASSERT_EQ(one.size(), two.size());
  for (std::size_t i = 0; i < one.size(); ++i) EXPECT_EQ(one[i].indices, two[i].indices);
}

TEST(GrowPlanes, RefusesACloudWithoutNormalsOrWithAnotherGrid) {
  GridScan scan = scan_room(0.002);
  GridScan bare = scan;
  bare.cloud.normals.clear();
  EXPECT_NE(error_of([&] { grow_planes(bare.cloud, bare.grid); }).find("normals"),
            std::string::npos);
  scan.grid.point.back() = 1000000;
  EXPECT_NE(error_of([&] { grow_planes(scan.cloud, scan.grid); }), "");
  EXPECT_TRUE(grow_planes({}, {}).empty());
}

}  // namespace
}  // namespace facula
