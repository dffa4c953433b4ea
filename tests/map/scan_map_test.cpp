// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/map/scan_map.hpp>
#include <facula/tests/map/random_scans.hpp>
#include <facula/tests/support/matchers.hpp>

#include <algorithm>
#include <map>
#include <set>

namespace facula {
namespace {

constexpr double kResolution = 0.1;

/// Inserted one after the other, as if nothing had ever been kept.
OccupancyMap inserted_anew(const ScanMap& scans) {
  OccupancyMap map(scans.map().options());
  for (const KeptScan& scan : scans.scans()) map.insert(unpack(scan.cells));
  return map;
}

ScanCells cells_at(const PointCloud& cloud, const RigidTransform& pose) {
  return cells_of_scan(transformed(cloud, pose), {.resolution = kResolution});
}

ScanRecord record_of(const std::string& name, const RigidTransform& pose) {
  return {
      .name = name, .world_from_scan = pose, .points = 1000, .cast = {.resolution = kResolution}};
}

ScanMap map_of_scans(std::size_t count) {
  ScanMap scans({.resolution = kResolution});
  Random random(5);
  for (std::size_t i = 0; i < count; ++i) {
    scans.add("scan " + std::to_string(i), random_scan(i, 1000), random_pose(random));
  }
  return scans;
}

TEST(PackedCells, GiveBackEveryCell) {
  for (const double resolution : {0.5, 0.1, 0.02}) {
    const ScanCells cells = cells_of_scan(random_scan(1, 3000), {.resolution = resolution});
    const ScanCells back = unpack(pack(cells));
    EXPECT_TRUE(back.bricks == cells.bricks);
    EXPECT_EQ(back.skipped, cells.skipped);
  }
  EXPECT_TRUE(unpack(pack({})).bricks.empty());
}

TEST(PackedCells, HoldTheFirstAndTheLastBrickOfSpaceWithFullMasks) {
  ScanCells cells;
  cells.skipped = 3;
  cells.bricks = {{0, CellMask::all(), {}}, {(std::uint64_t{1} << 39) - 1, {}, CellMask::all()}};
  const PackedCells packed = pack(cells);
  EXPECT_TRUE(unpack(packed).bricks == cells.bricks);
  EXPECT_EQ(unpack(packed).skipped, 3U);
  // Two masks of one kind of word each: a varint and 2 bytes a mask.
  EXPECT_EQ(packed.blocks.front().raw_size, 1U + (1 + 4) + (6 + 4));
}

TEST(PackedCells, KeepWhatHitsOfUnsurePointsCount) {
  PointCloud cloud = random_scan(1, 3000);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    cloud.sigma.push_back(0.01F * static_cast<float>(i % 30));
  }
  const ScanCells cells = cells_of_scan(cloud, {.resolution = kResolution, .weigh_sigma = true});
  EXPECT_TRUE(unpack(pack(cells)).bricks == cells.bricks);
  ScanMap scans({.resolution = kResolution, .weigh_sigma = true});
  scans.add("sure", random_scan(2, 2000), {});
  scans.add("unsure", cloud, {});
  scans.remove("sure");
  EXPECT_TRUE(is_same_map(scans.map(), inserted_anew(scans)));
}

TEST(PackedCells, TakeATenthOfTheCellsOfARoomAndAreTheSameForAnyThreads) {
  PointCloud room = random_scan(1, 100000);  // pushed out to the walls
  for (Eigen::Vector3f& x : room.points) {
    const Eigen::Array3f part = x.array().abs() / Eigen::Array3f(2, 1.5F, 1);
    x /= part.maxCoeff();
  }
  const ScanCells cells = cells_of_scan(room, {.resolution = 0.05});
  const PackedCells one = pack(cells, 1);
  const PackedCells two = pack(cells, 2);
  ASSERT_EQ(one.blocks.size(), two.blocks.size());
  for (std::size_t i = 0; i < one.blocks.size(); ++i) {
    EXPECT_TRUE(one.blocks[i].bytes == two.blocks[i].bytes);
  }
  EXPECT_LT(10 * one.memory_usage(), cells.bricks.size() * sizeof(ScanBrick));
}

TEST(PackedCells, SayWhenABlockIsDamaged) {
  const ScanCells cells = cells_of_scan(random_scan(1, 300), {.resolution = kResolution});
  const Bytes whole = scan_bricks_bytes(std::span(cells.bricks).first(20));
  for (std::size_t kept = 0; kept < whole.size(); ++kept) {
    EXPECT_FALSE(error_of([&] { parse_scan_bricks(ByteView(whole).first(kept)); }).empty());
  }
  PackedCells packed = pack(cells);
  packed.blocks.front().bytes[20] ^= 0xff;
  EXPECT_FALSE(error_of([&] { unpack(packed); }).empty());
}

TEST(ScanMap, IsTheMapOfItsScansInOrder) {
  const ScanMap scans = map_of_scans(8);
  OccupancyMap direct({.resolution = kResolution});
  Random random(5);
  for (std::size_t i = 0; i < 8; ++i) {
    direct.insert(transformed(random_scan(i, 1000), random_pose(random)));
  }
  EXPECT_TRUE(is_same_map(scans.map(), direct));
  EXPECT_TRUE(is_same_map(scans.map(), inserted_anew(scans)));
}

TEST(ScanMap, StaysTheMapOfItsScansWhateverIsRemovedOrReplaced) {
  ScanMap scans = map_of_scans(12);
  Random random(9);
  std::size_t made = 12;
  for (int change = 0; change < 60; ++change) {
    const auto& kept = scans.scans();
    const std::string name = kept.empty() ? "" : kept[random.below(kept.size())].record.name;
    const std::uint64_t what = random.below(3);
    const RigidTransform pose = random_pose(random);
    const PointCloud cloud = random_scan(random.below(100), 1 + random.below(2000));
    if (kept.empty() || what == 0) {
      scans.add("scan " + std::to_string(made++), cloud, pose);
    } else if (what == 1) {
      scans.remove(name);
    } else {
      scans.replace(record_of(name, pose), cells_at(cloud, pose));
    }
    ASSERT_TRUE(is_same_map(scans.map(), inserted_anew(scans))) << "after change " << change;
  }
  EXPECT_GT(scans.map().statistics().occupied_cells, 500U) << "the test tests nothing";
}

TEST(ScanMap, IsEmptyWhenTheLastScanWentAway) {
  ScanMap scans = map_of_scans(2);
  scans.remove("scan 0");
  scans.remove("scan 1");
  EXPECT_TRUE(scans.scans().empty());
  EXPECT_TRUE(scans.map().bricks().sorted().empty());
}

TEST(ScanMap, KeepsTheOrderOfScansWhereClampsMakeItMatter) {
  // Nine misses reach the lower bound and forget the hit before them, but not one behind them.
  const ScanRecord record = record_of("0", {});
  PointCloud wall;
  wall.points.emplace_back(1.05F, 0.05F, 0.05F);
  wall.sensor_origin.emplace_back(0.05F, 0.05F, 0.05F);
  PointCloud beyond = wall;
  beyond.points.front().x() = 2.05F;
  ScanMap scans({.resolution = kResolution});
  for (int i = 0; i < 13; ++i) scans.add(std::to_string(i), i < 10 ? beyond : wall, {});
  scans.replace(record, cells_at(wall, {}));
  EXPECT_TRUE(is_same_map(scans.map(), inserted_anew(scans)));
  ScanMap last({.resolution = kResolution});
  for (int i = 1; i < 13; ++i) last.add(std::to_string(i), i < 10 ? beyond : wall, {});
  last.add(record, cells_at(wall, {}));
  EXPECT_FALSE(is_same_map(scans.map(), last.map())) << "order does not matter here";
}

TEST(ScanMap, TouchesNoBrickThatNeitherTheOldNorTheNewCellsTouch) {
  const ScanMap built = map_of_scans(10);
  const ScanCells old_cells = unpack(built.scans()[4].cells);
  RigidTransform pose = built.scans()[4].record.world_from_scan;
  pose.translation.x() += 0.7;
  const ScanCells new_cells = cells_at(random_scan(4, 1000), pose);
  std::set<std::uint64_t> touched;
  for (const ScanBrick& brick : old_cells.bricks) touched.insert(brick.code);
  for (const ScanBrick& brick : new_cells.bricks) touched.insert(brick.code);

  // A value that no scan would make marks every brick: where it stays, nothing was computed.
  OccupancyMap marked({.resolution = kResolution});
  for (const LogOddsMap::Entry* entry : built.map().bricks().sorted()) {
    marked.bricks().find_or_add(entry->code).fill(0.123F);
  }
  std::vector<KeptScan> kept(built.scans().begin(), built.scans().end());
  ScanMap scans(std::move(marked), std::move(kept));
  const Rebuild rebuild = scans.replace(record_of(built.scans()[4].record.name, pose), new_cells);
  EXPECT_EQ(rebuild.bricks, touched.size());

  const OccupancyMap expected = inserted_anew(scans);
  std::size_t marks = 0;
  for (const LogOddsMap::Entry* entry : scans.map().bricks().sorted()) {
    LogOddsBrick::Values values{};
    LogOddsBrick::Values right{};
    const CellMask known = entry->brick.read(values);
    if (touched.contains(entry->code)) {
      const LogOddsBrick* brick = expected.bricks().find(entry->code);
      ASSERT_NE(brick, nullptr);
      ASSERT_TRUE(brick->read(right) == known && values == right);
    } else {
      ASSERT_EQ(entry->brick.value(0), 0.123F);
      ++marks;
    }
  }
  EXPECT_GT(marks, 100U) << "the scan touched everything: the test tests nothing";
}

TEST(ScanMap, OpensOnlyTheBlocksThatMayHoldATouchedBrick) {
  ScanMap scans({.resolution = 0.02});
  RigidTransform far;
  far.translation = {100, 100, 100};
  scans.add("near", random_scan(1, 2000), {});
  scans.add("far", random_scan(2, 2000), far);
  const std::size_t near_blocks = scans.scans()[0].cells.blocks.size();
  ASSERT_GT(near_blocks, 3U);
  EXPECT_EQ(scans.remove("far").blocks, 0U);
  EXPECT_EQ(scans.scans().front().cells.blocks.size(), near_blocks);
}

TEST(ScanMap, KeepsTwoHundredScansAtTwoHundredTimesTheMemoryOfOne) {
  ScanMap one({.resolution = kResolution});
  one.add("0", random_scan(0, 200), {});
  ScanMap many({.resolution = kResolution});
  for (int i = 0; i < 200; ++i) many.add(std::to_string(i), random_scan(0, 200), {});
  EXPECT_LE(many.scan_memory(), 200 * one.scan_memory() + 200 * 64);
  EXPECT_TRUE(is_same_map(many.map(), inserted_anew(many)));
}

TEST(ScanMap, SaysWhatItCannotDo) {
  ScanMap scans = map_of_scans(2);
  const ScanCells cells = cells_at(random_scan(1, 10), {});
  EXPECT_NE(error_of([&] { scans.remove("none"); }).find("'scan 0'"), std::string::npos);
  EXPECT_NE(error_of([&] { scans.add(record_of("scan 1", {}), cells); }).find("already"),
            std::string::npos);
  EXPECT_NE(error_of([&] { scans.add(record_of("", {}), cells); }).find("name"), std::string::npos);
  ScanRecord coarse = record_of("scan 1", {});
  coarse.cast.resolution = 0.2;
  EXPECT_NE(error_of([&] { scans.replace(coarse, cells); }).find("0.2 m"), std::string::npos);
  EXPECT_NE(error_of([&] { ScanMap().remove("x"); }).find("keeps 0"), std::string::npos);
  EXPECT_TRUE(is_same_map(scans.map(), inserted_anew(scans))) << "a refusal changed the map";
}

}  // namespace
}  // namespace facula
