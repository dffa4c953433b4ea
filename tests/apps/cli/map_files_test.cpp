// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/cloud_file.hpp>
#include <facula/acquire/core/whole_file.hpp>
#include <facula/map/map_file.hpp>
#include <facula/map/scan_graph.hpp>
#include <facula/tests/apps/cli/program_run.hpp>
#include <facula/tests/map/random_scans.hpp>
#include <facula/tests/support/temporary_folder.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace facula {
namespace {

using Json = nlohmann::json;

constexpr double kResolution = 0.1;

/// Free but for a block of occupied cells, 2 x 2 x 2 m from 0 on.
OccupancyMap room_with_block(int x) {
  OccupancyMap map({.resolution = kResolution});
  CellMask occupied;
  for (int place = 0; place < 8; ++place) {
    occupied.set(cell_in_brick({x + (place & 1), place >> 1 & 1, place >> 2}));
  }
  for (int i = 0; i < 16; ++i) {
    ScanCells cells;
    for (const std::uint64_t code : {0, 1, 2, 3, 4, 5, 6, 7}) {
      const CellKey first = first_cell(code);
      const CellKey key = {first[0] + kCentreKey, first[1] + kCentreKey, first[2] + kCentreKey};
      cells.bricks.push_back({brick_code(key), CellMask::all(), {}});
    }
    cells.bricks.front().passed = ~occupied;
    cells.bricks.front().ended = occupied;
    map.insert(cells);
  }
  return map;
}

class MapFiles : public testing::Test {
 protected:
  void SetUp() override {
    room_with_block(1).write(folder_ / "before.ot");
    room_with_block(5).write(folder_ / "after.fmap");
  }

  Json figures(const std::string& line) {
    const ProgramRun run = run_line(line + " --json -", folder_.path());
    EXPECT_EQ(run.code, 0) << run.err;
    return Json::parse(run.out, nullptr, false);
  }

  ProgramRun run(const std::string& line) { return run_line(line, folder_.path()); }

  TemporaryFolder folder_;
};

TEST_F(MapFiles, DiffListsAndColorsWhatMoved) {
  const Json json =
      figures("facula map diff before.ot after.fmap --slack-cells 0 --out diff.ply --csv diff.csv");
  EXPECT_EQ(json["compared_cells"], 8 * 512);
  EXPECT_EQ(json["changed_cells"], 16);
  ASSERT_EQ(json["clusters"].size(), 2U);
  EXPECT_EQ(json["clusters"][0]["change"], "appeared");
  EXPECT_EQ(json["clusters"][1]["change"], "vanished");
  EXPECT_NEAR(json["clusters"][0]["x_m"].get<double>(), 0.6, 1e-9);
  EXPECT_NEAR(json["clusters"][1]["x_m"].get<double>(), 0.2, 1e-9);
  EXPECT_NEAR(json["clusters"][0]["volume_m3"].get<double>(), 0.008, 1e-12);
  const PointCloud cloud = read_cloud(folder_ / "diff.ply");
  EXPECT_EQ(cloud.size(), 16U);
  EXPECT_EQ(cloud.colors.size(), 16U);
  EXPECT_TRUE(read_whole_file(folder_ / "diff.csv").starts_with("change,cells,volume_m3"));
}

TEST_F(MapFiles, DiffSeesThroughThePose) {
  const Json json = figures(
      "facula map diff before.ot after.fmap --slack-cells 0 --position-mm -400 0 0 --out "
      "none.ply");
  EXPECT_EQ(json["cluster_count"], 0);
  EXPECT_EQ(json["compared_cells"], 12 * 16 * 16);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "none.ply"));
}

TEST_F(MapFiles, MergeKeepsTheFirstMapsFrame) {
  const Json json = figures(
      "facula map merge before.ot after.fmap --position-mm 1600 0 0 --out both.fmap --out both.bt");
  EXPECT_EQ(json["exact"], true);
  EXPECT_EQ(json["new_cells"], 8 * 512);
  EXPECT_EQ(json["joined_cells"], 0);
  EXPECT_EQ(figures("facula info both.fmap")["occupied_cells"], 16);
  EXPECT_EQ(figures("facula info both.bt")["occupied_cells"], 16);
  EXPECT_EQ(
      figures("facula map merge before.ot after.fmap --position-mm 50 0 0 --out x.bt")["exact"],
      false);
}

TEST_F(MapFiles, InfoNamesTheScansThatAMapKeeps) {
  ScanMap scans({.resolution = kResolution});
  RigidTransform pose;
  pose.translation = {1, 2, 3};
  scans.add("hall", random_scan(1, 500), pose);
  scans.add("stairs", random_scan(2, 700), {});
  write_map_file(folder_ / "kept.fmap", scans.map(), scans.scans());
  const Json json = figures("facula info kept.fmap");
  EXPECT_EQ(json["kept_scans"], 2);
  EXPECT_EQ(json["scans"][0]["name"], "hall");
  EXPECT_EQ(json["scans"][0]["z_m"], 3);
  EXPECT_EQ(json["scans"][1]["points"], 700);
}

/// Three scans, the middle one `shift` metres aside.
ScanGraph three_scans(float shift) {
  ScanGraph graph;
  for (std::uint32_t i = 0; i < 3; ++i) {
    GraphScan& scan = graph.scans.emplace_back();
    scan.id = i;
    scan.points = random_scan(i, 2000).points;
    scan.world_from_scan.translation = {static_cast<float>(i), i == 1 ? shift : 0.3F, 0.1F};
    scan.world_from_scan.rotation = Eigen::AngleAxisf(0.7F, Eigen::Vector3f(1, 2, 3).normalized());
  }
  return graph;
}

OccupancyMap map_of(const std::vector<GraphScan>& scans) {
  OccupancyMap map({.resolution = 0.05});
  for (const GraphScan& scan : scans) map.insert(world_cloud(scan));
  return map;
}

TEST_F(MapFiles, ALogOfOctoMapIsAProjectWhoseMapIsOctoMaps) {
  const ScanGraph graph = three_scans(0.5F);
  write_scan_graph(folder_ / "log.graph", graph);
  EXPECT_EQ(figures("facula info log.graph")["scan_count"], 3);
  const Json json = figures("facula map log.graph --resolution-mm 50 --verify --out log.ot");
  EXPECT_EQ(json["same_as_octomap"], true);
  EXPECT_TRUE(is_same_map(OccupancyMap::read(folder_ / "log.ot"), map_of(graph.scans)));
}

TEST_F(MapFiles, ALogOfALogIsTheSame) {
  ScanGraph graph = three_scans(0.5F);
  write_scan_graph(folder_ / "log.graph", graph);
  figures("facula map log.graph --out again.graph");
  EXPECT_EQ(read_whole_file(folder_ / "again.graph"), read_whole_file(folder_ / "log.graph"));
  EXPECT_EQ(run("facula map before.ot --out x.graph").code, 2);
}

TEST_F(MapFiles, ALogSeesEveryPointFromTheMeanOriginOfItsScan) {
  PointCloud cloud;
  cloud.points = {{1, 0, 0.5F}, {2, 1, 0}, {std::nanf(""), 0, 0}, {-1, 3, 1}, {0, 2, -1}};
  cloud.sensor_origin = {{0.5F, 0, 0}, {0, 0.5F, 0}, {0, 0, 0}, {-0.5F, 0, 1}, {0, -0.5F, 0.25F}};
  write_cloud(folder_ / "turned.ply", cloud);
  figures("facula map turned.ply --out turned.graph");
  const ScanGraph log = read_scan_graph(folder_ / "turned.graph");
  ASSERT_EQ(log.scans.size(), 1U);
  EXPECT_EQ(log.scans[0].world_from_scan.translation, Eigen::Vector3f(0, 0, 0.3125F));
  const PointCloud world = world_cloud(log.scans[0]);
  ASSERT_EQ(world.size(), 4U);
  EXPECT_EQ(world.points[0], cloud.points[0]);
  EXPECT_EQ(world.points[2], cloud.points[3]);
}

TEST_F(MapFiles, ABoxKeepsOnlyRaysThatEndInIt) {
  PointCloud cloud;
  cloud.points = {{1.02F, 0.02F, 0.02F}, {0.02F, 1.02F, 0.02F}, {1500, 0, 0}};
  cloud.sensor_origin.assign(3, {0.02F, 0.02F, 0.02F});
  write_cloud(folder_ / "stray.ply", cloud);
  const std::string box = " --box-min-m -0.5,-0.5,-0.5 --box-max-m 1.5 0.5 0.5";
  const Json json = figures("facula map stray.ply --verify --out boxed.ot" + box);
  EXPECT_EQ(json["occupied_cells"], 1);
  EXPECT_EQ(json["free_cells"], 20);  // of 5 cm, from the origin's on
  EXPECT_EQ(figures("facula map stray.ply --out boxed.fmap" + box)["free_cells"], 20);
  for (const char* wrong : {" --box-min-m 0 0 0",
                            " --box-max-m 1 1 1",
                            " --box-min-m 0 0 2 --box-max-m 1 1 1",
                            " --box-min-m 0 0 --box-max-m 1 1 1"}) {
    EXPECT_EQ(run("facula map stray.ply --out x.bt" + std::string(wrong)).code, 2) << wrong;
  }
  EXPECT_EQ(run("facula map boxed.ot --out x.bt" + box).code, 2);
  EXPECT_EQ(run("facula map stray.ply --out x.bt --box-min-m 0 0 0 --box-max-m 9e9 1 1").code, 1);
}

TEST_F(MapFiles, KeptScansAreRemovedAndReplacedAsIfMappedAnew) {
  std::filesystem::create_directory(folder_ / "moved");
  const ScanGraph graph = three_scans(0.5F);
  const ScanGraph moved = three_scans(0.9F);
  write_scan_graph(folder_ / "log.graph", graph);
  write_scan_graph(folder_ / "moved" / "log.graph", moved);
  figures("facula map log.graph --resolution-mm 50 --out kept.fmap");
  EXPECT_EQ(figures("facula map kept.fmap --remove log_1 --out less.fmap")["scans_left"], 2);
  const MapFile less = read_map_file(folder_ / "less.fmap");
  EXPECT_EQ(less.scans.size(), 2U);
  EXPECT_TRUE(is_same_map(less.map, map_of({graph.scans[0], graph.scans[2]})));
  const Json json = figures("facula map moved/log.graph --update kept.fmap --out new.fmap");
  EXPECT_EQ(json["scans_replaced"], 1);
  EXPECT_EQ(json["scans_unchanged"], 2);
  EXPECT_TRUE(is_same_map(OccupancyMap::read(folder_ / "new.fmap"), map_of(moved.scans)));
  EXPECT_EQ(run("facula map kept.fmap --remove nobody --out x.fmap").code, 1);
  EXPECT_EQ(run("facula map after.fmap --update kept.fmap --out x.fmap").code, 2);
}

TEST_F(MapFiles, DamageIsOneSentence) {
  const std::string whole = read_whole_file(folder_ / "after.fmap");
  folder_.write("torn.fmap", whole.substr(0, whole.size() / 2));
  folder_.write("torn.graph", std::string("\5\0\0\0\1\0\0\0", 8));
  std::string flipped = whole;
  flipped[whole.size() / 2] = static_cast<char>(flipped[whole.size() / 2] ^ 1);
  folder_.write("flipped.fmap", flipped);
  for (const char* line : {"facula info torn.fmap",
                           "facula map torn.graph --out x.bt",
                           "facula map diff before.ot flipped.fmap",
                           "facula map merge torn.fmap before.ot --out x.bt"}) {
    const ProgramRun damaged = run(line);
    EXPECT_EQ(damaged.code, 1) << line;
    EXPECT_EQ(std::count(damaged.err.begin(), damaged.err.end(), '\n'), 1) << damaged.err;
  }
  EXPECT_FALSE(std::filesystem::exists(folder_ / "x.bt"));
  EXPECT_EQ(run("facula map diff before.ot").code, 2);
}

}  // namespace
}  // namespace facula
