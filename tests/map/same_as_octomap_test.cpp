// SPDX-License-Identifier: GPL-3.0-or-later
// The map is liboctomap's own, byte for byte: 800 seeded random scans.
#include <facula/acquire/core/random.hpp>
#include <facula/map/octomap_bridge.hpp>
#include <facula/map/octomap_judge.hpp>
#include <facula/tests/support/real_data.hpp>

#include <array>
#include <cmath>
#include <limits>
#include <sstream>

#include <gtest/gtest.h>

namespace facula {
namespace {

constexpr int kMaps = 140;
constexpr int kScansPerMap = 4;
constexpr std::array<double, 8> kResolutions = {0.01, 0.02, 0.03, 0.05, 0.1, 0.2, 0.25, 0.5};

/// Rounded to a cell's border where the dice say so.
Eigen::Vector3f place(Random& random, double reach, double resolution) {
  Eigen::Vector3f x;
  for (int i = 0; i < 3; ++i) {
    double along = reach * (2 * random.uniform() - 1);
    if (random.below(4) == 0) along = resolution * std::round(along / resolution);
    x[i] = static_cast<float>(along);
  }
  return x;
}

/// Points in a cube of some sixty cells: some on borders, some in the origin's cell, some that are
/// no numbers or far outside the tree.
PointCloud random_scan(Random& random, double resolution) {
  const double reach = 30 * resolution;
  const Eigen::Vector3f origin = place(random, reach / 3, resolution);
  const float far = std::numeric_limits<float>::max();
  PointCloud cloud;
  const std::size_t count = 40 + random.below(400);
  for (std::size_t i = 0; i < count; ++i) {
    Eigen::Vector3f x = place(random, reach, resolution);
    if (random.below(20) == 0) x = origin;
    if (random.below(20) == 0) x = origin + place(random, resolution / 2, resolution);
    if (random.below(20) == 0) x[static_cast<int>(random.below(3))] = origin.x();
    if (random.below(100) == 0) x.y() = std::numeric_limits<float>::quiet_NaN();
    if (random.below(100) == 0) x.z() = random.below(2) == 0 ? far : -far;
    if (random.below(100) == 0) x.x() = static_cast<float>(40000 * resolution);
    cloud.points.push_back(x);
  }
  cloud.sensor_origin.assign(cloud.size(), origin);
  return cloud;
}

OccupancyOptions random_options(Random& random) {
  OccupancyOptions options{.resolution = kResolutions[random.below(kResolutions.size())]};
  const double cells = 5 + 30 * random.uniform();
  if (random.below(2) == 0) options.max_range = cells * options.resolution;
  options.num_threads = 1 + static_cast<int>(random.below(3));
  return options;
}

std::string file_of(const OccupancyMap& map, bool binary) {
  std::ostringstream bytes;
  (binary ? write_bt : write_ot)(bytes, map.bricks(), map.resolution());
  return bytes.str();
}

std::string file_of(octomap::OcTree& tree, bool binary) {
  std::ostringstream bytes;
  if (binary) {
    tree.writeBinary(bytes);
  } else {
    tree.write(bytes);
  }
  return bytes.str();
}

/// Inserts scans into both maps as they come, NaN and all, and compares whole files.
TEST(SameAsOctoMap, ForRandomScansByteForByte) {
  testing::internal::CaptureStderr();  // liboctomap has a line for every point outside its tree
  std::size_t skipped = 0;
  std::size_t cut = 0;
  for (int seed = 0; seed < kMaps; ++seed) {
    Random random(static_cast<std::uint64_t>(seed), 55);
    const OccupancyOptions options = random_options(random);
    OccupancyMap map(options);
    octomap::OcTree tree(options.resolution);
    for (int scan = 0; scan < kScansPerMap; ++scan) {
      const PointCloud cloud = random_scan(random, options.resolution);
      map.insert(cloud);
      tree.insertPointCloud(to_octomap(cloud),
                            to_octomap(cloud.sensor_origin.front()),
                            options.max_range > 0 ? options.max_range : -1);
      ASSERT_TRUE(file_of(map, false) == file_of(tree, false)) << "seed " << seed << scan;
    }
    ASSERT_TRUE(file_of(map, true) == file_of(tree, true)) << "seed " << seed;
    skipped += map.skipped_points();
    cut += options.max_range > 0 ? 1 : 0;
  }
  testing::internal::GetCapturedStderr();
  EXPECT_GT(skipped, 500U);
  EXPECT_GT(cut, 50U);
}

TEST(SameAsOctoMap, WithBoxesAndWithOneRayPerCell) {
  testing::internal::CaptureStderr();
  for (int seed = 0; seed < 60; ++seed) {
    Random random(static_cast<std::uint64_t>(seed), 56);
    OccupancyOptions options = random_options(random);
    options.discretize = seed % 2 == 0;
    if (seed % 3 != 0) {
      const auto reach = static_cast<float>(20 * options.resolution);
      options.box = MapBox{{-reach, -reach, -reach / 3}, {reach, reach * 0.77F, reach / 2}};
    }
    OccupancyMap map(options);
    OctomapJudge judge(options);
    for (int scan = 0; scan < kScansPerMap; ++scan) {
      const PointCloud cloud = random_scan(random, options.resolution);
      map.insert(cloud);
      judge.insert(cloud);
    }
    const OctomapVerdict verdict = judge.verdict(map);
    ASSERT_TRUE(verdict.same_ot && verdict.same_bt) << "seed " << seed;
    ASSERT_EQ(verdict.nodes, map.statistics().nodes);
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST(SameAsOctoMap, WithASensorModelOfOnesOwn) {
  const OccupancyOptions options{
      .resolution = 0.1, .hit = 0.9, .miss = 0.45, .clamp_min = 0.03, .clamp_max = 0.999};
  Random random(3, 57);
  OccupancyMap map(options);
  OctomapJudge judge(options);
  for (int scan = 0; scan < 20; ++scan) {  // more than sixteen different values in a brick
    const PointCloud cloud = random_scan(random, options.resolution);
    map.insert(cloud);
    judge.insert(cloud);
  }
  const OctomapVerdict verdict = judge.verdict(map);
  EXPECT_TRUE(verdict.same_ot);
  EXPECT_TRUE(verdict.same_bt);
}

TEST(SameAsOctoMap, ForColumnsWithOriginsOfTheirOwn) {
  Random random(4, 58);
  const OccupancyOptions options{.resolution = 0.05};
  PointCloud cloud;
  for (int column = 0; column < 30; ++column) append(cloud, random_scan(random, 0.05));
  OccupancyMap map(options);
  OctomapJudge judge(options);
  map.insert(cloud);
  judge.insert(cloud);
  EXPECT_TRUE(judge.verdict(map).same_ot);
}

TEST(SameAsOctoMap, SeesADifferenceOfOneCell) {
  Random random(5, 59);
  const OccupancyOptions options{.resolution = 0.05};
  const PointCloud cloud = random_scan(random, 0.05);
  OccupancyMap map(options);
  OctomapJudge judge(options);
  map.insert(cloud);
  judge.insert(cloud);
  ASSERT_TRUE(judge.verdict(map).same_ot);
  ScanCells one;
  one.bricks.push_back({brick_code({30000, 30000, 30000}), {}, {}});
  one.bricks.front().ended.set(5);
  map.insert(one);
  EXPECT_FALSE(judge.verdict(map).same_ot);
  EXPECT_FALSE(judge.verdict(map).same_bt);
}

TEST(CellsOfScan, AreTheReferencesWhateverTheWay) {
  for (int seed = 0; seed < 40; ++seed) {
    Random random(static_cast<std::uint64_t>(seed), 60);
    const OccupancyOptions options = random_options(random);
    PointCloud cloud = random_scan(random, options.resolution);
    append(cloud, random_scan(random, options.resolution));
    const ScanCells fast = cells_of_scan(cloud, options.cast());
    const ScanCells reference = cells_of_scan_reference(cloud, options.cast());
    ASSERT_TRUE(fast.bricks == reference.bricks) << "seed " << seed;
    ASSERT_EQ(fast.skipped, reference.skipped) << "seed " << seed;
  }
}

TEST(CellsOfScan, AreTheReferencesWhereRaysLieTooFarApartForOneSetOfBits) {
  constexpr double kResolution = 0.01;
  Random random(6, 61);
  PointCloud cloud;
  for (int scan = 0; scan < 300; ++scan) {
    PointCloud part = random_scan(random, kResolution);
    const Eigen::Vector3f shift = scan % 2 * Eigen::Vector3f(200, -200, 3);
    for (Eigen::Vector3f& x : part.points) x += shift;
    for (Eigen::Vector3f& x : part.sensor_origin) x += shift;
    append(cloud, part);
  }
  ASSERT_GT(cloud.size(), 60000U);  // several pieces of work
  CastOptions options{.resolution = kResolution, .num_threads = 3};
  for (const bool boxed : {false, true}) {
    if (boxed) options.box = MapBox{{-0.2F, -0.1F, -0.2F}, {200.1F, 0.2F, 0.1F}};
    const ScanCells fast = cells_of_scan(cloud, options);
    const ScanCells reference = cells_of_scan_reference(cloud, options);
    EXPECT_TRUE(fast.bricks == reference.bricks) << boxed;
    EXPECT_EQ(fast.skipped, reference.skipped) << boxed;
    EXPECT_GT(fast.bricks.size(), 100U) << boxed;
  }
}

}  // namespace
}  // namespace facula
