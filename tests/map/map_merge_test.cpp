// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/map/map_merge.hpp>
#include <facula/tests/map/random_scans.hpp>
#include <facula/tests/support/matchers.hpp>

#include <algorithm>
#include <limits>
#include <map>

namespace facula {
namespace {

constexpr double kResolution = 0.1;

OccupancyMap map_of(std::uint64_t seed, std::size_t scans, double resolution = kResolution) {
  OccupancyMap map({.resolution = resolution});
  for (std::size_t i = 0; i < scans; ++i) map.insert(random_scan(seed + i, 1500));
  return map;
}

/// Log-odds by cell.
std::map<CellKey, float> cells_of(const OccupancyMap& map) {
  std::map<CellKey, float> cells;
  for (const LogOddsMap::Entry* entry : map.bricks().sorted()) {
    LogOddsBrick::Values values{};
    const CellKey first = first_cell(entry->code);
    for_each_cell(entry->brick.read(values), [&](std::size_t place) {
      const auto part = [&](std::size_t i) {
        return first[i] + static_cast<int>(place >> (3 * i) & 7);
      };
      cells[{part(0), part(1), part(2)}] = values[place];
    });
  }
  return cells;
}

float bounded(const OccupancyMap& map, float value) {
  return std::clamp(value, map.options().model().min, map.options().model().max);
}

/// The merged map by the definition, cell by cell of all that lies about both.
std::map<CellKey, float> merged_slowly(const OccupancyMap& target,
                                       const OccupancyMap& source,
                                       const RigidTransform& target_from_source) {
  std::map<CellKey, float> cells = cells_of(target);
  Eigen::AlignedBox3d box;
  for (const auto& [key, value] : cells_of(source)) {
    box.extend(target_from_source * centre_of(key, source.resolution()));
  }
  const double reach = 2 * source.resolution() + 2 * target.resolution();
  const CellKey low = cell_of(box.min().array() - reach, target.resolution()).value_or(CellKey{});
  const CellKey high = cell_of(box.max().array() + reach, target.resolution()).value_or(CellKey{});
  const RigidTransform source_from_target = target_from_source.inverse();
  for (int z = low[2]; z <= high[2]; ++z) {
    for (int y = low[1]; y <= high[1]; ++y) {
      for (int x = low[0]; x <= high[0]; ++x) {
        const CellKey key = {x, y, z};
        const auto value =
            source.log_odds(source_from_target * centre_of(key, target.resolution()));
        if (value) cells[key] = bounded(target, cells[key] + *value);
      }
    }
  }
  return cells;
}

RigidTransform turned(double angle, const Eigen::Vector3d& axis, const Eigen::Vector3d& shift) {
  return {Eigen::Quaterniond(Eigen::AngleAxisd(angle, axis)), shift};
}

TEST(MapMerge, AddsLogOddsCellByCellAtShiftsByWholeCells) {
  for (const CellKey& shift : {CellKey{0, 0, 0}, CellKey{3, -5, 11}, CellKey{16, 8, -24}}) {
    OccupancyMap target = map_of(1, 3);
    const OccupancyMap source = map_of(20, 4);
    std::map<CellKey, float> expected = cells_of(target);
    std::size_t joined = 0;
    for (const auto& [key, value] : cells_of(source)) {
      const CellKey there = {key[0] + shift[0], key[1] + shift[1], key[2] + shift[2]};
      joined += expected.count(there);
      expected[there] = bounded(target, expected[there] + value);
    }
    const Eigen::Vector3d metres = kResolution * Eigen::Vector3d(shift[0], shift[1], shift[2]);
    const MapMerge merge = merge_map(target, source, {Eigen::Quaterniond::Identity(), metres});
    EXPECT_TRUE(merge.exact);
    EXPECT_EQ(merge.joined_cells, joined);
    EXPECT_EQ(merge.new_cells + merge.joined_cells, cells_of(source).size());
    EXPECT_TRUE(cells_of(target) == expected);
  }
}

TEST(MapMerge, KeepsEveryCellAtTurnsByRightAngles) {
  const OccupancyMap source = map_of(3, 2);
  const std::map<CellKey, float> cells = cells_of(source);
  OccupancyMap target({.resolution = kResolution});
  const MapMerge merge =
      merge_map(target, source, turned(M_PI / 2, Eigen::Vector3d::UnitZ(), {0.2, 0, 0}));
  EXPECT_TRUE(merge.exact);
  EXPECT_EQ(merge.new_cells, cells.size());
  const std::map<CellKey, float> found = cells_of(target);
  ASSERT_EQ(found.size(), cells.size());
  for (const auto& [key, value] : cells) {
    // x' = -y, y' = x: cell k begins at (k - 32768) cells.
    const CellKey there = {2 * kCentreKey - 1 - key[1] + 2, key[0], key[2]};
    ASSERT_TRUE(found.contains(there));
    ASSERT_EQ(found.at(there), value);
  }
}

TEST(MapMerge, ResamplesAtAnyPoseAndResolutionAsTheDefinitionSays) {
  Random random(8);
  for (const double resolution : {0.1, 0.23, 0.04}) {
    const RigidTransform pose = turned(
        random.uniform(), Eigen::Vector3d(1, 2, 3).normalized(), {random.uniform(), 0.05, -0.31});
    OccupancyMap target = map_of(5, 1);
    const OccupancyMap source = map_of(9, 1, resolution);
    const std::map<CellKey, float> expected = merged_slowly(target, source, pose);
    EXPECT_FALSE(merge_map(target, source, pose).exact);
    EXPECT_TRUE(cells_of(target) == expected) << resolution;
  }
}

TEST(MapMerge, CallsNoPoseExactThatIsNot) {
  const OccupancyMap source = map_of(1, 1);
  const auto exact = [&](const RigidTransform& pose, double resolution = kResolution) {
    OccupancyMap target({.resolution = resolution});
    return merge_map(target, source, pose).exact;
  };
  EXPECT_TRUE(exact(turned(M_PI, Eigen::Vector3d::UnitX(), {0.5, 0, 0})));
  EXPECT_FALSE(exact(turned(0, Eigen::Vector3d::UnitX(), {0.55, 0, 0})));
  EXPECT_FALSE(exact(turned(0.001, Eigen::Vector3d::UnitX(), {0, 0, 0})));
  EXPECT_FALSE(exact(turned(0, Eigen::Vector3d::UnitX(), {0, 0, 0}), 0.2));
}

TEST(MapMerge, IsTheSameForAnyNumberOfThreads) {
  const RigidTransform pose = turned(0.4, Eigen::Vector3d(1, 1, 1).normalized(), {1, 2, 3});
  OccupancyMap one({.resolution = 0.03, .num_threads = 1});
  OccupancyMap two({.resolution = 0.03, .num_threads = 2});
  const OccupancyMap source = map_of(1, 2, 0.05);
  merge_map(one, source, pose);
  merge_map(two, source, pose);
  EXPECT_TRUE(is_same_map(one, two));
}

TEST(MapMerge, LeavesOutWhatLiesOutsideTheGrid) {
  const OccupancyMap source = map_of(1, 1);
  OccupancyMap target({.resolution = kResolution});
  const double edge = kCentreKey * kResolution;
  merge_map(target, source, turned(0, Eigen::Vector3d::UnitX(), {edge, 0, 0}));
  const std::map<CellKey, float> kept = cells_of(target);
  std::size_t expected = 0;
  for (const auto& [key, value] : cells_of(source)) expected += key[0] < kCentreKey ? 1 : 0;
  EXPECT_EQ(kept.size(), expected);
  merge_map(target, source, turned(0, Eigen::Vector3d::UnitX(), {1e9, 0, 0}));
  EXPECT_EQ(cells_of(target).size(), expected);
}

TEST(MapMerge, SaysWhatItCannotDo) {
  const OccupancyMap source = map_of(1, 1, 1.0);
  OccupancyMap target({.resolution = 1e-4});
  EXPECT_NE(error_of([&] { merge_map(target, source); }).find("larger cells"), std::string::npos);
  RigidTransform nowhere;
  nowhere.translation.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(error_of([&] { merge_map(target, source, nowhere); }).find("finite"),
            std::string::npos);
}

}  // namespace
}  // namespace facula
