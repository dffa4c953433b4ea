// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/reconstruct/register/scan_pyramid.hpp>
#include <facula/tests/reconstruct/corner_scan.hpp>
#include <facula/tests/support/matchers.hpp>

#include <limits>
#include <numeric>

#include <gtest/gtest.h>

namespace facula {
namespace {

TEST(BuildPyramid, HalvesTheResolutionFromLevelToLevel) {
  const PosedCloud scan = corner_scan(1, 4000, 0.001);
  const ScanPyramid pyramid = build_pyramid(scan, {.finest_voxel = 0.04, .levels = 3});
  ASSERT_EQ(pyramid.levels.size(), 3U);
  EXPECT_EQ(pyramid.name, "corner");
  EXPECT_TRUE(pyramid.oriented);
  EXPECT_NEAR(pyramid.diameter, std::sqrt(4 + 4 + 1.5 * 1.5), 0.02);
  for (std::size_t i = 0; i < 3; ++i) {
    const PyramidLevel& level = pyramid.levels[i];
    EXPECT_EQ(level.voxel, 0.04 * std::pow(2, double(i)));
    ASSERT_EQ(level.cloud.normals.size(), level.cloud.size());
    EXPECT_EQ(level.tree.nearest(level.cloud.points[7]).index, 7U);
    const double merged = std::accumulate(level.merged.begin(), level.merged.end(), 0.0);
    EXPECT_NEAR(merged, double(scan.cloud.size()), 0.01 * merged);
  }
}

TEST(BuildPyramid, NormalsAreThoseOfTheSurfacesAndFaceTheScanner) {
  const ScanPyramid pyramid = build_pyramid(patch_scan({{-1, -1, 0}, {2, 0, 0}, {0, 2, 0}}, 1));
  for (const PyramidLevel& level : pyramid.levels) {
    for (const Eigen::Vector3f& normal : level.cloud.normals) EXPECT_GT(normal.z(), 0.99F);
  }
}

TEST(BuildPyramid, ChoosesAVoxelThatScalesWithTheScan) {
  PosedCloud scan = corner_scan(1, 4000, 0);
  const double voxel = build_pyramid(scan).levels[0].voxel;
  for (Eigen::Vector3f& p : scan.cloud.points) p *= 0.01F;
  for (Eigen::Vector3f& p : scan.cloud.sensor_origin) p *= 0.01F;
  EXPECT_NEAR(build_pyramid(scan).levels[0].voxel, 0.01 * voxel, 1e-5 * voxel);
}

TEST(BuildPyramid, PassesOverPointsThatAreNotFinite) {
  PosedCloud scan = corner_scan(1, 1000, 0);
  const ScanPyramid clean = build_pyramid(scan);
  scan.cloud.points.insert(scan.cloud.points.begin() + 5,
                           Eigen::Vector3f::Constant(std::numeric_limits<float>::quiet_NaN()));
  scan.cloud.sensor_origin.push_back(scan.cloud.sensor_origin.front());
  const ScanPyramid pyramid = build_pyramid(scan);
  EXPECT_EQ(pyramid.levels[0].cloud.points, clean.levels[0].cloud.points);
}

TEST(BuildPyramid, SaysWhatAScanLacks) {
  const auto says = [](std::vector<Eigen::Vector3f> points, const char* word) {
    PosedCloud scan;
    scan.name = "poor";
    scan.cloud.points = std::move(points);
    const std::string sentence = error_of([&] { build_pyramid(scan); });
    EXPECT_NE(sentence.find("'poor'"), std::string::npos) << sentence;
    EXPECT_NE(sentence.find(word), std::string::npos) << sentence;
  };
  says({}, "0 finite points");
  says({{1, 2, 3}}, "1 finite points");
  const float nan = std::numeric_limits<float>::quiet_NaN();
  says(std::vector<Eigen::Vector3f>(100, {nan, 0, 0}), "0 finite points");
  says(std::vector<Eigen::Vector3f>(100, {1, 2, 3}), "in one spot");
  std::vector<Eigen::Vector3f> line;
  for (int i = 0; i < 100; ++i) line.emplace_back(0.1F * float(i), 0.2F * float(i), 1.0F);
  says(line, "one line");
}

TEST(BuildPyramid, BearsDuplicatePoints) {
  PosedCloud scan = corner_scan(1, 1000, 0);
  const double voxel = build_pyramid(scan).levels[0].voxel;
  const PosedCloud once = scan;
  for (int i = 0; i < 3; ++i) append(scan.cloud, once.cloud);
  EXPECT_NEAR(build_pyramid(scan).levels[0].voxel, voxel, 0.05 * voxel);
}

TEST(BuildPyramid, ChecksItsOptions) {
  const PosedCloud scan = corner_scan(1, 1000, 0);
  const auto sentence = [&](const PyramidOptions& options) {
    return error_of([&] { build_pyramid(scan, options); });
  };
  EXPECT_NE(sentence({.finest_voxel = -1}).find("finest_voxel"), std::string::npos);
  EXPECT_NE(sentence({.levels = 9}).find("levels"), std::string::npos);
  EXPECT_NE(sentence({.normal_neighbours = 2}).find("normal_neighbours"), std::string::npos);
  EXPECT_NE(sentence({.finest_voxel = 10}).find("smaller voxel"), std::string::npos);
}

}  // namespace
}  // namespace facula
