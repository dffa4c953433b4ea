// SPDX-License-Identifier: GPL-3.0-or-later
// The maps of all real sets are liboctomap's own, byte for byte.
#include <facula/map/octomap_judge.hpp>
#include <facula/reconstruct/register/scan_project.hpp>
#include <facula/tests/support/real_data.hpp>

#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace facula {
namespace {

std::vector<std::filesystem::path> files_of(const std::filesystem::path& folder,
                                            const std::string& extension) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() == extension) files.push_back(entry.path());
  }
  return files;
}

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
  const std::vector<std::filesystem::path> scans = files_of(set / "data", ".xz");
  ASSERT_EQ(scans.size(), 10U);
  for (const auto& scan : scans) {
    PointCloud cloud = read_scan_project(scan).scans.front().cloud;
    cloud.sensor_origin.assign(cloud.size(), {0, 0.1F, 0.5F});
    const bool first = scan.filename() == "bun000.ply.xz";
    const OccupancyOptions options{.resolution = first ? 0.002 : 0.005};
    OccupancyMap map(options);
    OctomapJudge judge(options);
    map.insert(cloud);
    judge.insert(cloud);
    EXPECT_TRUE(judge.verdict(map).same_ot) << scan;
  }
}

TEST(SameAsOctoMap, ForRoomsOfADepthCamera) {
  FACULA_REQUIRE_REAL_DATA(set, "range/pcl-data");
  expect_same(set / "room_scan1.pcd", {.resolution = 0.05});
  expect_same(set / "room_scan2.pcd", {.resolution = 0.05, .discretize = true});
}

TEST(SameAsOctoMap, ForASpinningRangeFinder) {
  FACULA_REQUIRE_REAL_DATA(set, "range/os3ds-rotating-lidar");
  const std::vector<std::filesystem::path> scans = files_of(set, ".csv");
  ASSERT_EQ(scans.size(), 8U);
  for (const auto& scan : scans) expect_same(scan, {.resolution = 0.05});
}

TEST(SameAsOctoMap, ForTheCloudsOfPclsTests) {
  FACULA_REQUIRE_REAL_DATA(set, "range/pcl-test");
  const std::vector<std::filesystem::path> clouds = files_of(set, ".pcd");
  ASSERT_EQ(clouds.size(), 3U);
  for (const auto& cloud : clouds) expect_same(cloud, {.resolution = 0.01});
}

TEST(SameAsOctoMap, ForOctoMapsOwnDemonstrationScan) {
  FACULA_REQUIRE_REAL_DATA(set, "range/octomap-maps");
  expect_same(set / "scan.dat.xz", {.resolution = 0.1});
}

}  // namespace
}  // namespace facula
