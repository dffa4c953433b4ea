// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/map/cell_clusters.hpp>
#include <facula/map/map_diff.hpp>
#include <facula/tests/map/random_scans.hpp>
#include <facula/tests/support/matchers.hpp>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <set>

namespace facula {
namespace {

constexpr double kResolution = 0.1;

/// Cells counted from 0 m.
struct Block {
  CellKey from;
  CellKey to;  ///< exclusive
};

/// Space of 20 x 20 x 20 cells from 0 m on, free but for these blocks.
OccupancyMap room_with(const std::vector<Block>& blocks) {
  OccupancyMap map({.resolution = kResolution});
  LogOddsBrick::Values values{};
  const auto set = [&](const Block& block, float value) {
    for (int z = block.from[2]; z < block.to[2]; ++z) {
      for (int y = block.from[1]; y < block.to[1]; ++y) {
        for (int x = block.from[0]; x < block.to[0]; ++x) {
          const CellKey cell = {x + kCentreKey, y + kCentreKey, z + kCentreKey};
          LogOddsBrick& brick = map.bricks().find_or_add(brick_code(cell));
          CellMask known = brick.read(values);
          known.set(cell_in_brick(cell));
          values[cell_in_brick(cell)] = value;
          brick.assign(values, known);
        }
      }
    }
  };
  set({{0, 0, 0}, {20, 20, 20}}, -1);
  for (const Block& block : blocks) set(block, 2);
  return map;
}

TEST(MapDiff, FindsNothingBetweenAMapAndItself) {
  const OccupancyMap map = room_with({{{3, 3, 3}, {6, 6, 6}}});
  const MapDiff diff = diff_maps(map, map, {}, {.newly_seen = true});
  EXPECT_TRUE(diff.clusters.empty());
  EXPECT_EQ(diff.compared_cells, 8000U);
}

TEST(MapDiff, ListsWhatAppearedAndVanishedWithVolumeCentreAndBox) {
  const OccupancyMap before = room_with({{{2, 2, 2}, {4, 4, 4}}, {{10, 0, 0}, {11, 20, 20}}});
  const OccupancyMap after = room_with({{{15, 4, 6}, {18, 7, 9}}, {{10, 0, 0}, {11, 20, 20}}});
  const MapDiff diff = diff_maps(before, after);
  ASSERT_EQ(diff.clusters.size(), 2U);
  const ChangeCluster& appeared = diff.clusters[0];
  EXPECT_EQ(appeared.kind, ChangeKind::kAppeared);
  EXPECT_EQ(appeared.cells, 27U);
  EXPECT_NEAR(appeared.volume, 0.027, 1e-12);
  EXPECT_TRUE(is_near_point(appeared.centre, {1.65, 0.55, 0.75}, 1e-9));
  EXPECT_TRUE(is_near_point(appeared.min, {1.5, 0.4, 0.6}, 1e-9));
  EXPECT_TRUE(is_near_point(appeared.max, {1.8, 0.7, 0.9}, 1e-9));
  EXPECT_EQ(diff.clusters[1].kind, ChangeKind::kVanished);
  EXPECT_EQ(diff.clusters[1].cells, 8U);
  EXPECT_TRUE(is_near_point(diff.clusters[1].centre, {0.3, 0.3, 0.3}, 1e-9));

  const PointCloud cloud = cloud_of_changes(diff);
  ASSERT_EQ(cloud.size(), 35U);
  EXPECT_GT(cloud.colors.front()[1], cloud.colors.front()[0]) << "appeared is green";
  EXPECT_GT(cloud.colors.back()[0], cloud.colors.back()[1]) << "vanished is red";
}

TEST(MapDiff, ComparesThroughThePoseOfTheSecondMap) {
  // The second map is the first one, seen in a frame turned by a right angle and shifted.
  RigidTransform before_from_after;
  before_from_after.rotation = Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitZ());
  before_from_after.translation = {2, 0, 0};
  const OccupancyMap after = room_with({{{2, 5, 8}, {3, 6, 9}}});
  const MapDiff diff = diff_maps(room_with({}), after, before_from_after);
  EXPECT_EQ(diff.compared_cells, 8000U);
  ASSERT_EQ(diff.clusters.size(), 1U);
  EXPECT_TRUE(is_near_point(
      diff.clusters[0].centre, before_from_after * Eigen::Vector3d(0.25, 0.55, 0.85), 1e-9));
}

TEST(MapDiff, TakesWhatNobodySawBeforeForNewOnlyWhenAsked) {
  const OccupancyMap before = room_with({});
  const OccupancyMap after = room_with({{{18, 5, 5}, {22, 6, 6}}});
  EXPECT_EQ(diff_maps(before, after).clusters.size(), 1U);
  const MapDiff diff = diff_maps(before, after, {}, {.newly_seen = true});
  ASSERT_EQ(diff.clusters.size(), 2U);
  EXPECT_EQ(diff.clusters[1].kind, ChangeKind::kNewlySeen);
  EXPECT_EQ(diff.clusters[1].cells, 2U);
}

TEST(MapDiff, LeavesOutWhatMovedByTheSlackOrIsTooSmall) {
  const OccupancyMap before = room_with({{{10, 0, 0}, {11, 20, 20}}, {{2, 2, 2}, {3, 3, 3}}});
  const OccupancyMap after = room_with({{{11, 0, 0}, {12, 20, 20}}, {{6, 6, 6}, {7, 7, 8}}});
  const MapDiff all = diff_maps(before, after, {}, {.slack_cells = 0});
  ASSERT_EQ(all.clusters.size(), 4U);
  EXPECT_EQ(all.clusters[0].cells, 400U);
  const MapDiff moved = diff_maps(before, after, {}, {.slack_cells = 1});
  ASSERT_EQ(moved.clusters.size(), 2U);
  EXPECT_EQ(moved.clusters[0].cells, 2U);
  const MapDiff large = diff_maps(before, after, {}, {.slack_cells = 1, .min_cells = 2});
  ASSERT_EQ(large.clusters.size(), 1U);
  EXPECT_EQ(large.left_out_cells, 1U);
  EXPECT_EQ(large.cells.size(), 2U);
  EXPECT_NE(error_of([&] { diff_maps(before, after, {}, {.slack_cells = -1}); }).find("slack"),
            std::string::npos);
}

TEST(MapDiff, AgreesWithALookAtEveryCellOfRandomMaps) {
  OccupancyMap before({.resolution = kResolution});
  OccupancyMap after({.resolution = kResolution});
  for (std::uint64_t i = 0; i < 3; ++i) {
    before.insert(random_scan(i, 1500));
    after.insert(random_scan(10 + i, 1500));
  }
  std::size_t appeared = 0;
  std::size_t vanished = 0;
  for (int z = -15; z < 15; ++z) {
    for (int y = -20; y < 20; ++y) {
      for (int x = -25; x < 25; ++x) {
        const CellKey cell = {x + kCentreKey, y + kCentreKey, z + kCentreKey};
        const CellState was = before.state_of_cell(cell);
        const CellState is = after.state_of_cell(cell);
        appeared += was == CellState::kFree && is == CellState::kOccupied ? 1 : 0;
        vanished += was == CellState::kOccupied && is == CellState::kFree ? 1 : 0;
      }
    }
  }
  ASSERT_GT(appeared, 100U);
  std::map<ChangeKind, std::size_t> found;
  const MapDiff diff = diff_maps(before, after, {}, {.slack_cells = 0});
  for (const ChangedCell& cell : diff.cells) ++found[diff.clusters[cell.cluster].kind];
  EXPECT_EQ(found[ChangeKind::kAppeared], appeared);
  EXPECT_EQ(found[ChangeKind::kVanished], vanished);
  EXPECT_TRUE(std::is_sorted(diff.clusters.begin(),
                             diff.clusters.end(),
                             [](const auto& a, const auto& b) { return a.cells > b.cells; }));
}

TEST(CellClusters, AreTheGroupsThatAFloodFindsFromCellToCell) {
  Random random(6);
  std::set<CellKey> distinct;
  while (distinct.size() < 900) {
    const auto key = [&](int least) { return least + static_cast<int>(random.below(24)); };
    distinct.insert({key(0), key(kKeyLimit - 24), key(100)});
  }
  const std::vector<CellKey> cells(distinct.begin(), distinct.end());
  const std::vector<std::size_t> numbers = cell_clusters(cells);
  std::vector<std::size_t> expected(cells.size(), cells.size());
  std::size_t groups = 0;
  for (std::size_t seed = 0; seed < cells.size(); ++seed) {
    if (expected[seed] != cells.size()) continue;
    std::vector<std::size_t> front = {seed};
    expected[seed] = groups;
    while (!front.empty()) {
      const CellKey at = cells[front.back()];
      front.pop_back();
      for (std::size_t i = 0; i < cells.size(); ++i) {
        int apart = 0;
        for (std::size_t axis = 0; axis < 3; ++axis) {
          apart = std::max(apart, std::abs(cells[i][axis] - at[axis]));
        }
        if (apart > 1 || expected[i] != cells.size()) continue;
        expected[i] = groups;
        front.push_back(i);
      }
    }
    ++groups;
  }
  EXPECT_GT(groups, 50U);
  EXPECT_LT(groups, 800U);
  EXPECT_EQ(numbers, expected);
  EXPECT_TRUE(cell_clusters({}).empty());
}

}  // namespace
}  // namespace facula
