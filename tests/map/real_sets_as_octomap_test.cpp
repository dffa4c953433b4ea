// SPDX-License-Identifier: GPL-3.0-or-later
// The maps of all real sets are liboctomap's own, byte for byte.
#include <facula/map/octomap_judge.hpp>
#include <facula/reconstruct/register/scan_project.hpp>
#include <facula/tests/support/real_data.hpp>

#include <gtest/gtest.h>

namespace facula {
namespace {

void expect_same(const std::filesystem::path& set, const OccupancyOptions& options) {
  const ScanProject project = read_scan_project(set);
  OccupancyMap map(options);
  OctomapJudge judge(options);
  for (const PosedCloud& scan : project.scans) {
    const PointCloud cloud = transformed(scan.cloud, scan.world_from_scan);
    map.insert(cloud);
    judge.insert(cloud);
  }
  const OctomapVerdict verdict = judge.verdict(map);
  EXPECT_TRUE(verdict.same_ot) << set;
  EXPECT_TRUE(verdict.same_bt) << set;
  EXPECT_GT(verdict.nodes, 500U) << set;
  EXPECT_LT(map.bricks().memory_usage(), verdict.memory) << set;
}

TEST(SameAsOctoMap, ForACorridorOfThreeScans) {
  FACULA_REQUIRE_REAL_DATA(set, "range/3dtk-dat");
  expect_same(set, {.resolution = 0.05});
  expect_same(set, {.resolution = 0.1, .max_range = 8});
}

TEST(SameAsOctoMap, ForTheBunny) {
  FACULA_REQUIRE_REAL_DATA(set, "range/stanford-bunny");
  const ScanProject project = read_scan_project(set / "data/bun000.ply.xz");
  PointCloud cloud = project.scans.front().cloud;
  cloud.sensor_origin.assign(cloud.size(), {0, 0.1F, 0.5F});
  const OccupancyOptions options{.resolution = 0.002};
  OccupancyMap map(options);
  OctomapJudge judge(options);
  map.insert(cloud);
  judge.insert(cloud);
  EXPECT_TRUE(judge.verdict(map).same_ot);
}

TEST(SameAsOctoMap, ForRoomsOfADepthCamera) {
  FACULA_REQUIRE_REAL_DATA(set, "range/pcl-data");
  expect_same(set / "room_scan1.pcd", {.resolution = 0.05});
  expect_same(set / "room_scan2.pcd", {.resolution = 0.05, .discretize = true});
}

TEST(SameAsOctoMap, ForASpinningRangeFinder) {
  FACULA_REQUIRE_REAL_DATA(set, "range/os3ds-rotating-lidar");
  expect_same(set / "210716-1531-LiDAR-90-Moderate.csv", {.resolution = 0.05});
}

TEST(SameAsOctoMap, ForOctoMapsOwnDemonstrationScan) {
  FACULA_REQUIRE_REAL_DATA(set, "range/octomap-maps");
  expect_same(set / "scan.dat.xz", {.resolution = 0.1});
}

}  // namespace
}  // namespace facula
