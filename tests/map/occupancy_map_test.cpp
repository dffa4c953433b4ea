// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/random.hpp>
#include <facula/map/octomap_bridge.hpp>
#include <facula/tests/support/matchers.hpp>

#include <cmath>
#include <limits>
#include <set>
#include <sstream>
#include <tuple>

#include <gtest/gtest.h>

namespace facula {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

std::string bytes_of(const octomap::OcTree& tree) {
  std::ostringstream bytes;
  tree.write(bytes);
  return bytes.str();
}

/// As OctoMap writes the map.
std::string bytes_of(const OccupancyMap& map) {
  return bytes_of(*to_octomap(map));
}

PointCloud seen_from(const Eigen::Vector3f& origin, std::vector<Eigen::Vector3f> points) {
  PointCloud cloud;
  cloud.points = std::move(points);
  cloud.sensor_origin.assign(cloud.size(), origin);
  return cloud;
}

/// Points in a flat box: some close together, some far off, some on cell borders.
PointCloud random_cloud(std::uint64_t seed, std::size_t count, const Eigen::Vector3f& origin) {
  Random random(seed);
  std::vector<Eigen::Vector3f> points(count);
  for (auto& x : points) {
    x = {static_cast<float>(random.uniform() * 8 - 4),
         static_cast<float>(random.uniform() * 6 - 3),
         static_cast<float>(random.uniform() * 3 - 1)};
    if (random.below(10) == 0) x = (x * 10).array().round() / 10;
    if (random.below(50) == 0) x = origin;
  }
  return seen_from(origin, std::move(points));
}

float log_odds_at(const OccupancyMap& map, const Eigen::Vector3d& x) {
  return map.log_odds(x).value_or(kNan);
}

struct Setting {
  double resolution;
  double max_range;
};

class SameAsOctoMap : public testing::TestWithParam<Setting> {};

TEST_P(SameAsOctoMap, ForScansOfOneOriginByteForByte) {
  const auto [resolution, max_range] = GetParam();
  OccupancyMap map({.resolution = resolution, .max_range = max_range});
  octomap::OcTree reference(resolution);
  for (std::uint64_t scan = 0; scan < 3; ++scan) {
    const float shift = 0.1F * static_cast<float>(scan);
    const Eigen::Vector3f origin(0.3F - shift, shift, 0.2F);
    const PointCloud cloud = random_cloud(7 + scan, 5000, origin);
    map.insert(cloud);
    reference.insertPointCloud(
        to_octomap(cloud), to_octomap(origin), max_range > 0 ? max_range : -1);
    ASSERT_EQ(map.statistics().nodes, reference.size()) << "after scan " << scan;
    ASSERT_TRUE(bytes_of(map) == bytes_of(reference)) << "after scan " << scan;
  }
  EXPECT_EQ(map.skipped_points(), 0U);
}

INSTANTIATE_TEST_SUITE_P(ResolutionsAndRanges,
                         SameAsOctoMap,
                         testing::Values(Setting{0.5, 0},
                                         Setting{0.1, 0},
                                         Setting{0.05, 0},
                                         Setting{1.0 / 30, 0},
                                         Setting{0.1, 2},
                                         Setting{0.07, 1.3},
                                         Setting{3, 0}));

TEST(OccupancyMap, SaturatedAndPrunedTreesStayTheSameAsOctoMaps) {
  const Eigen::Vector3f origin(0.01F, 0.02F, 0.03F);
  OccupancyMap map({.resolution = 0.2});
  octomap::OcTree reference(0.2);
  for (int round = 0; round < 12; ++round) {
    // The same cloud again and again fills and prunes; then another one opens pruned leaves again.
    const PointCloud cloud = random_cloud(round < 8 ? 1 : 2, 5000, origin);
    map.insert(cloud);
    reference.insertPointCloud(to_octomap(cloud), to_octomap(origin));
    ASSERT_TRUE(bytes_of(map) == bytes_of(reference)) << "after round " << round;
  }
  octomap::OcTree expanded(reference);
  expanded.expand();
  EXPECT_GT(expanded.size(), reference.size()) << "nothing was pruned: the test tests nothing";
  // A tree that was never pruned is the same map as the pruned one.
  OccupancyMap unpruned = from_octomap(expanded);
  const PointCloud cloud = random_cloud(3, 20, origin);
  unpruned.insert(cloud);
  reference.insertPointCloud(to_octomap(cloud), to_octomap(origin));
  EXPECT_TRUE(bytes_of(unpruned) == bytes_of(reference));
}

TEST(OccupancyMap, DoesNotDependOnThreads) {
  const PointCloud cloud = random_cloud(3, 100000, {0, 0, 0});
  OccupancyMap one({.resolution = 0.1, .num_threads = 1});
  OccupancyMap many({.resolution = 0.1, .num_threads = 5});
  one.insert(cloud);
  many.insert(cloud);
  EXPECT_TRUE(bytes_of(one) == bytes_of(many));
}

TEST(OccupancyMap, AddsLogOddsAndClamps) {
  const double hit = std::log(0.7 / 0.3);
  const double miss = std::log(0.4 / 0.6);
  OccupancyMap map({.resolution = 0.1});
  const PointCloud cloud = seen_from({0.05F, 0.05F, 0.05F}, {{1.05F, 0.05F, 0.05F}});
  for (int n = 1; n <= 12; ++n) {
    map.insert(cloud);
    EXPECT_NEAR(
        log_odds_at(map, {1.05, 0.05, 0.05}), std::min(n * hit, std::log(0.971 / 0.029)), 1e-5)
        << n << " hits";
    EXPECT_NEAR(
        log_odds_at(map, {0.55, 0.05, 0.05}), std::max(n * miss, std::log(0.1192 / 0.8808)), 1e-5)
        << n << " misses";
  }
}

TEST(OccupancyMap, WalksTheRayThatASamplerFinds) {
  // Brute force: step along the ray in steps of 1/2000 cell and collect cells that are clearly in.
  Random random(11);
  const double edge = 0.1;
  for (int trial = 0; trial < 50; ++trial) {
    const auto coordinate = [&] { return static_cast<float>(random.uniform() * 2 - 1); };
    const Eigen::Vector3f origin(coordinate(), coordinate(), coordinate());
    const Eigen::Vector3f end(coordinate(), coordinate(), coordinate());
    OccupancyMap map({.resolution = edge});
    map.insert(seen_from(origin, {end}));
    const Eigen::Vector3d from = origin.cast<double>();
    const Eigen::Vector3d way = end.cast<double>() - from;
    std::set<std::tuple<int, int, int>> cells;
    const auto cell_of = [&](const Eigen::Vector3d& x) {
      const Eigen::Vector3i c = (x / edge).array().floor().cast<int>();
      return std::tuple(c.x(), c.y(), c.z());
    };
    const auto steps = static_cast<int>(way.norm() / edge * 2000) + 1;
    for (int i = 0; i <= steps; ++i) cells.insert(cell_of(from + way * i / steps));
    const auto last = cell_of(end.cast<double>());
    std::size_t missed = 0;
    for (const auto& cell : cells) {
      const auto [x, y, z] = cell;
      const Eigen::Vector3d centre = (Eigen::Vector3d(x, y, z).array() + 0.5) * edge;
      const CellState expected = cell == last ? CellState::kOccupied : CellState::kFree;
      if (map.state(centre) != expected) ++missed;
    }
    const MapStatistics statistics = map.statistics();
    const std::size_t known = statistics.free_cells + statistics.occupied_cells;
    // A corner clipped by less than a sample's step may be in one set and not in the other.
    EXPECT_LE(missed, 1U) << "trial " << trial;
    EXPECT_NEAR(static_cast<double>(known), static_cast<double>(cells.size()), 1) << trial;
    EXPECT_EQ(statistics.occupied_cells, 1U);
  }
}

TEST(OccupancyMap, LeavesUnknownWhatLiesBehindAWall) {
  // Two columns of a scan with their own origins see the wall x = 2 m.
  PointCloud cloud;
  for (int column = 0; column < 2; ++column) {
    for (int i = -40; i <= 40; ++i) {
      for (int k = -20; k <= 20; ++k) {
        cloud.points.emplace_back(
            2.02F, 0.025F * static_cast<float>(i), 0.025F * static_cast<float>(k));
        cloud.sensor_origin.emplace_back(0.02F, column == 0 ? -0.3F : 0.3F, 0.01F);
      }
    }
  }
  OccupancyMap map({.resolution = 0.05});
  map.insert(cloud);
  for (double y = -0.9; y < 0.9; y += 0.1) {
    EXPECT_EQ(map.state({2.02, y, 0.02}), CellState::kOccupied) << y;
    EXPECT_EQ(map.state({2.12, y, 0.02}), CellState::kUnknown) << y;
    EXPECT_EQ(map.state({1.92, y, 0.02}), CellState::kFree) << y;
  }
  EXPECT_EQ(map.state({1, 0, 0.02}), CellState::kFree);
  EXPECT_EQ(map.state({0.02, -0.3, 0.01}), CellState::kFree);
  EXPECT_EQ(map.state({-0.2, 0, 0}), CellState::kUnknown);
}

TEST(OccupancyMap, CountsEveryCellOncePerCall) {
  // 50 columns, each from its own origin, look through the same free cell at the same occupied one.
  PointCloud cloud;
  for (int i = 0; i < 50; ++i) {
    cloud.points.emplace_back(1.05F, 0.05F, 0.05F);
    cloud.sensor_origin.emplace_back(0.01F + 0.001F * static_cast<float>(i), 0.05F, 0.05F);
  }
  OccupancyMap map({.resolution = 0.1});
  map.insert(cloud);
  EXPECT_NEAR(log_odds_at(map, {1.05, 0.05, 0.05}), std::log(0.7 / 0.3), 1e-6);
  EXPECT_NEAR(log_odds_at(map, {0.55, 0.05, 0.05}), std::log(0.4 / 0.6), 1e-6);
}

TEST(OccupancyMap, KeepsAThinSurfaceThatOtherColumnsGraze) {
  // One column ends on the cell, thirty others pass through it: occupied wins within a call.
  PointCloud cloud = seen_from({0.05F, 1.05F, 0.05F}, {{1.05F, 0.05F, 0.05F}});
  for (int i = 0; i < 30; ++i) {
    cloud.points.emplace_back(2.05F, 0.05F, 0.05F);
    cloud.sensor_origin.emplace_back(0.05F + 0.01F * static_cast<float>(i), 0.05F, 0.05F);
  }
  OccupancyMap map({.resolution = 0.1});
  map.insert(cloud);
  EXPECT_EQ(map.state({1.05, 0.05, 0.05}), CellState::kOccupied);
}

TEST(OccupancyMap, ClearsOnlyUpToTheMaximumRange) {
  OccupancyMap map({.resolution = 0.1, .max_range = 1});
  map.insert(seen_from({0.05F, 0.05F, 0.05F}, {{5.05F, 0.05F, 0.05F}, {0.05F, 0.65F, 0.05F}}));
  EXPECT_EQ(map.state({0.95, 0.05, 0.05}), CellState::kFree);
  EXPECT_EQ(map.state({1.15, 0.05, 0.05}), CellState::kUnknown);
  EXPECT_EQ(map.state({5.05, 0.05, 0.05}), CellState::kUnknown);
  EXPECT_EQ(map.state({0.05, 0.65, 0.05}), CellState::kOccupied);
}

TEST(OccupancyMap, SkipsAndCountsPointsItCannotPlace) {
  const float infinity = std::numeric_limits<float>::infinity();
  PointCloud cloud = seen_from({0, 0, 0},
                               {{kNan, 0, 0},
                                {0, infinity, 0},
                                {1e30F, 0, 0},
                                {0, 0, 4000},
                                {3.4e38F, 3.4e38F, 3.4e38F},
                                {1, 0, 0}});
  cloud.points.emplace_back(1, 1, 1);
  cloud.sensor_origin.emplace_back(kNan, 0, 0);
  testing::internal::CaptureStderr();
  OccupancyMap map({.resolution = 0.1});
  map.insert(cloud);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(map.skipped_points(), 6U);
  EXPECT_EQ(map.statistics().occupied_cells, 1U);
  map.insert(cloud);
  EXPECT_EQ(map.skipped_points(), 12U);
}

TEST(OccupancyMap, SurvivesRaysLongerThanOctoMapsBufferAndShorterThanAFloatCanSquare) {
  OccupancyMap map({.resolution = 0.001});
  map.insert(seen_from({-32.7F, -32.7F, -32.7F}, {{32.7F, 32.6F, 32.5F}}));
  const auto steps = static_cast<double>(map.statistics().free_cells);
  EXPECT_NEAR(steps, 65400 + 65300 + 65200, 10);
  map.insert(seen_from({-1e-30F, -1e-30F, -1e-30F}, {{1e-30F, 1e-30F, 1e-30F}}));
  EXPECT_EQ(map.state({0.0005, 0.0005, 0.0005}), CellState::kOccupied);
}

TEST(OccupancyMap, TakesRaysOfAHundredKilometresAsFarAsCellsReach) {
  const PointCloud cloud = seen_from({0.025F, 0.025F, 0.025F}, {{1e5F, 0.025F, 0.025F}});
  OccupancyMap far({.resolution = 5});
  far.insert(cloud);
  EXPECT_EQ(far.statistics().free_cells, 20000U);
  EXPECT_EQ(far.statistics().occupied_cells, 1U);
  OccupancyMap fine({.resolution = 0.05});
  fine.insert(cloud);
  EXPECT_EQ(fine.skipped_points(), 1U);
  EXPECT_EQ(fine.statistics().nodes, 0U);
  OccupancyMap near({.resolution = 0.05, .max_range = 10});
  near.insert(cloud);
  EXPECT_EQ(near.skipped_points(), 0U);
  EXPECT_EQ(near.statistics().free_cells, 200U);
  EXPECT_EQ(near.statistics().occupied_cells, 0U);
}

TEST(OccupancyMap, EndsWalksThroughCellsOfAnySize) {
  for (const double resolution : {1e-30, 1e-25, 1e-12, 1e9}) {
    const auto reach = static_cast<float>(30000.5 * resolution);
    const PointCloud cloud = seen_from({-reach, -reach, -reach}, {{reach, reach, reach}});
    for (const double max_range : {0.0, 1e308}) {
      OccupancyMap map({.resolution = resolution, .max_range = max_range});
      map.insert(cloud);
      EXPECT_EQ(map.skipped_points(), 0U) << resolution;
      EXPECT_EQ(map.statistics().occupied_cells, 1U) << resolution;
    }
  }
}

TEST(OccupancyMap, IsUnknownOutsideTheTreeWithoutAWord) {
  const OccupancyMap map({.resolution = 0.1});
  testing::internal::CaptureStderr();
  EXPECT_EQ(map.state({1e9, 0, 0}), CellState::kUnknown);
  EXPECT_EQ(map.state({0, std::nan(""), 0}), CellState::kUnknown);
  EXPECT_EQ(map.state({0, 0, 0}), CellState::kUnknown);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST(OccupancyMap, AsksForSensorOrigins) {
  PointCloud cloud;
  cloud.points.emplace_back(1, 2, 3);
  OccupancyMap map;
  EXPECT_NE(error_of([&] { map.insert(cloud); }).find("seen from"), std::string::npos);
  map.insert(PointCloud{});
  EXPECT_EQ(map.statistics().nodes, 0U);
}

TEST(OccupancyMap, NamesTheOptionThatIsWrong) {
  const auto message = [](const OccupancyOptions& options) {
    return error_of([&] { OccupancyMap{options}; });
  };
  EXPECT_NE(message({.resolution = 0}).find("resolution"), std::string::npos);
  EXPECT_NE(message({.resolution = -0.05}).find("resolution"), std::string::npos);
  EXPECT_NE(message({.resolution = kNan}).find("resolution"), std::string::npos);
  EXPECT_NE(message({.resolution = 1e17}).find("at most 1e+09 m, got 1e+17"), std::string::npos);
  EXPECT_NE(message({.max_range = -1}).find("max_range"), std::string::npos);
  EXPECT_NE(message({.hit = 0.4}).find("hit"), std::string::npos);
  EXPECT_NE(message({.miss = 0.6}).find("miss"), std::string::npos);
  EXPECT_NE(message({.clamp_min = 0}).find("clamp_min"), std::string::npos);
  EXPECT_NE(message({.clamp_max = 1}).find("clamp_max"), std::string::npos);
}

TEST(OctomapBridge, CarriesTreesCloudsAndPosesBothWays) {
  const PointCloud cloud = random_cloud(5, 1000, {0.1F, 0.2F, 0.3F});
  octomap::OcTree tree(0.1);
  tree.setProbHit(0.8);
  tree.insertPointCloud(to_octomap(cloud), {0.1F, 0.2F, 0.3F});
  OccupancyMap map = from_octomap(tree);
  EXPECT_TRUE(bytes_of(map) == bytes_of(tree));
  map.insert(from_octomap(to_octomap(cloud), {0.1F, 0.2F, 0.3F}));
  tree.insertPointCloud(to_octomap(cloud), {0.1F, 0.2F, 0.3F});
  EXPECT_TRUE(bytes_of(map) == bytes_of(tree));

  Eigen::Matrix<double, 6, 1> twist;
  twist << 1, -2, 3, 0.4, -0.5, 0.6;
  const RigidTransform pose = exp_se3(twist);
  EXPECT_TRUE(is_near_pose(from_octomap(to_octomap(pose)), pose, 1e-6, 1e-6));
  const Eigen::Vector3f x(0.3F, -0.7F, 1.1F);
  EXPECT_TRUE(is_near_point(from_octomap(to_octomap(pose).transform(to_octomap(x))).cast<double>(),
                            pose * x.cast<double>(),
                            1e-6));
}

}  // namespace
}  // namespace facula
