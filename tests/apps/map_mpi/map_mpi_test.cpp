// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/polar_scan.hpp>
#include <facula/acquire/core/random.hpp>
#include <facula/acquire/core/scan_file.hpp>
#include <facula/acquire/core/text_numbers.hpp>
#include <facula/acquire/core/whole_file.hpp>
#include <facula/map/block_index.hpp>
#include <facula/map/occupancy_map.hpp>
#include <facula/reconstruct/register/scan_project.hpp>
#include <facula/tests/apps/cli/program_run.hpp>
#include <facula/tests/map/random_scans.hpp>
#include <facula/tests/support/temporary_folder.hpp>

#include <algorithm>
#include <cmath>
#include <sstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace facula {
namespace {

constexpr int kRows = 60;
constexpr int kCols = 90;

/// A room of 8 x 6 x 3 m with a pillar, seen from its middle by a head that swings about its axis.
/// Beside the pillar some points hang between it and the wall.
PolarScan room_scan(std::uint64_t seed, const RigidTransform& world_from_scan) {
  Random random(seed);
  PolarScan scan = PolarScan::empty(kRows, kCols);
  scan.world_from_scan = world_from_scan;
  for (int col = 0; col < kCols; ++col) {
    const double yaw = 2 * M_PI * col / kCols;
    const auto at = static_cast<std::size_t>(col);
    scan.axis_position[at] = yaw;
    scan.sensor_origin[at] = {0.1 * std::cos(yaw), 0.1 * std::sin(yaw), 0};
    for (int row = 0; row < kRows; ++row) {
      const double pitch = (row - kRows / 2) * 0.03;
      const Eigen::Vector3d ray(
          std::cos(pitch) * std::cos(yaw), std::cos(pitch) * std::sin(yaw), std::sin(pitch));
      const Eigen::Array3d walls = Eigen::Array3d(4, 3, 1.5) / ray.array().abs();
      double range = walls.minCoeff() + 0.003 * random.normal();
      if (col > 20 && col < 30) range = 0.4 * range;
      if (col == 20 || col == 30) range = 0.7 * range;
      if (row % 17 != 3) scan.set(scan.index(row, col), range * ray, 0.5F, 0.003F);
    }
  }
  return scan;
}

/// poses.toml and its scans, each of which also knows its own pose.
void make_project(const std::filesystem::path& folder, std::size_t scans) {
  Random random(7);
  ScanProject project;
  for (std::size_t i = 0; i < scans; ++i) {
    PosedCloud posed;
    posed.name = "s" + std::to_string(i);
    posed.file = folder / (posed.name + ".pcd");
    posed.world_from_scan = random_pose(random);
    write_scan(posed.file, room_scan(i, posed.world_from_scan));
    project.scans.push_back(posed);
  }
  write_poses(folder / "poses.toml", project);
}

class MapMpi : public testing::Test {
 protected:
  void SetUp() override {
    // Where facula-map-mpi was built its test must not pass by itself.
    ASSERT_EQ(run_line("command -v mpirun", folder_.path()).code, 0)
        << "expected mpirun beside the MPI library, got none; apps/setup.sh installs openmpi-bin";
  }

  ProgramRun run(const std::string& line) const { return run_line(line, folder_.path()); }

  ProgramRun on_ranks(std::size_t ranks, const std::string& words) const {
    return run("timeout 120 mpirun --oversubscribe --allow-run-as-root -n " + number_text(ranks) +
               " facula-map-mpi " + words);
  }

  std::string bytes(const std::string& name) const { return read_whole_file(folder_ / name); }

  /// The .ot of all blocks together.
  std::string merged(const std::string& folder) const {
    return ot_bytes(OccupancyMap::read(folder_ / folder / "map.blocks"));
  }

  /// Lines on standard error that are the program's own.
  static std::vector<std::string> complaints(const ProgramRun& run) {
    std::vector<std::string> own;
    std::istringstream lines(run.err);
    for (std::string line; std::getline(lines, line);) {
      if (line.starts_with("facula-map-mpi")) own.push_back(line);
    }
    return own;
  }

  TemporaryFolder folder_;
};

TEST_F(MapMpi, MakesTheMapOfOneProcessOnAnyNumberOfRanks) {
  make_project(folder_.path(), 7);
  const ProgramRun one =
      run("facula map poses.toml --register never --resolution-mm 60 --out one.ot --json one.json");
  ASSERT_EQ(one.code, 0) << one.err;
  const auto expected = nlohmann::json::parse(bytes("one.json"));
  ASSERT_GT(expected["mixed_removed"].get<int>(), 0);
  std::string index;
  for (const std::size_t ranks : {1, 2, 3, 4}) {
    const ProgramRun many =
        on_ranks(ranks, "poses.toml --resolution-mm 60 --out map --overwrite --json many.json");
    ASSERT_EQ(many.code, 0) << many.err;
    EXPECT_TRUE(merged("map") == bytes("one.ot")) << ranks;
    const auto found = nlohmann::json::parse(bytes("many.json"));
    for (const char* key : {"scans", "points", "mixed_removed", "free_cells", "occupied_cells"}) {
      EXPECT_EQ(found[key], expected[key]) << key << ", ranks " << ranks;
    }
    EXPECT_EQ(found["by_rank"].size(), ranks);
    EXPECT_EQ(found["exchanged_bytes_per_scan"].get<double>() > 0, ranks > 1);
    EXPECT_NE(many.out.find("peak memory"), std::string::npos) << many.out;
    // The files do not depend on who wrote them.
    if (ranks == 1) index = bytes("map/map.blocks");
    EXPECT_EQ(bytes("map/map.blocks"), index);
  }
  EXPECT_EQ(run("facula info map/map.blocks").code, 0);
}

TEST_F(MapMpi, TakesFilesWithTheirOwnPosesAndOptionsOfTheSensor) {
  make_project(folder_.path(), 3);
  const std::string words =
      "s2.pcd s0.pcd s1.pcd s0.pcd --resolution-mm 80 --max-range-m 2.5 --hit 0.8 --weigh-sigma ";
  const ProgramRun one = run("facula map " + words + "--register never --out one.ot");
  ASSERT_EQ(one.code, 0) << one.err;
  const ProgramRun many = on_ranks(3, words + "--threads 2 --out map");
  ASSERT_EQ(many.code, 0) << many.err;
  EXPECT_TRUE(merged("map") == bytes("one.ot"));
  const BlockIndex index = parse_block_index(bytes("map/map.blocks"), "map.blocks");
  EXPECT_EQ(index.options.hit, 0.8);
  EXPECT_EQ(index.scans, 4U);
}

TEST_F(MapMpi, TakesABox) {
  make_project(folder_.path(), 2);
  const std::string words = "poses.toml --box-min-m -1 -1 -0.5 --box-max-m 2 1 1 ";
  ASSERT_EQ(run("facula map " + words + "--register never --out one.ot").code, 0);
  ASSERT_EQ(run("facula map poses.toml --register never --out whole.ot").code, 0);
  const ProgramRun many = on_ranks(2, words + "--out map");
  ASSERT_EQ(many.code, 0) << many.err;
  EXPECT_TRUE(merged("map") == bytes("one.ot"));
  EXPECT_LT(bytes("one.ot").size(), bytes("whole.ot").size());
}

TEST_F(MapMpi, LeavesRanksIdleWhereScansAreFew) {
  make_project(folder_.path(), 2);
  ASSERT_EQ(run("facula map poses.toml --register never --out one.ot").code, 0);
  const ProgramRun many = on_ranks(4, "poses.toml --out map");
  ASSERT_EQ(many.code, 0) << many.err;
  EXPECT_TRUE(merged("map") == bytes("one.ot"));
  // Started without mpirun it is one rank.
  const ProgramRun alone = run("facula-map-mpi poses.toml --out alone");
  ASSERT_EQ(alone.code, 0) << alone.err;
  EXPECT_EQ(bytes("alone/map.blocks"), bytes("map/map.blocks"));
}

TEST_F(MapMpi, EndsOnAllRanksWhereOneCannotReadAScan) {
  make_project(folder_.path(), 5);
  const std::string whole = bytes("s3.pcd");
  folder_.write("s3.pcd", whole.substr(0, whole.size() / 2));
  const ProgramRun torn = on_ranks(2, "poses.toml --out map");  // s3 is rank 1's second scan
  EXPECT_EQ(torn.code, 1);
  ASSERT_EQ(complaints(torn).size(), 1U) << torn.err;
  EXPECT_TRUE(complaints(torn)[0].starts_with("facula-map-mpi, rank 1: ")) << torn.err;
  EXPECT_NE(complaints(torn)[0].find("s3.pcd"), std::string::npos) << torn.err;
  EXPECT_FALSE(has_file_like(folder_.path(), "map"));
}

TEST_F(MapMpi, ReplacesAMapOnlyWhenAskedAndNeverAnythingElse) {
  make_project(folder_.path(), 1);
  std::filesystem::create_directory(folder_ / "taken");
  folder_.write("taken/letter.txt", "dear");
  const ProgramRun taken = on_ranks(2, "poses.toml --out taken --overwrite");
  EXPECT_EQ(taken.code, 1);
  ASSERT_EQ(complaints(taken).size(), 1U) << taken.err;
  EXPECT_NE(complaints(taken)[0].find("holds something"), std::string::npos) << taken.err;
  EXPECT_EQ(bytes("taken/letter.txt"), "dear");
}

TEST_F(MapMpi, SaysOnceWhatIsWrongWithTheCommandLine) {
  const ProgramRun wrong = on_ranks(3, "poses.toml --out map --resolution 5");
  EXPECT_EQ(wrong.code, 2);
  ASSERT_EQ(complaints(wrong).size(), 1U) << wrong.err;
  EXPECT_NE(complaints(wrong)[0].find("--resolution-mm"), std::string::npos) << wrong.err;
  const ProgramRun absent = on_ranks(2, "poses.toml --out map");
  EXPECT_EQ(absent.code, 1);
  EXPECT_EQ(complaints(absent).size(), 1U) << absent.err;
  const ProgramRun help = run("facula-map-mpi --help");
  EXPECT_EQ(help.code, 0);
  EXPECT_NE(help.out.find("Usage: facula-map-mpi SCANS... --out PATH"), std::string::npos);
}

}  // namespace
}  // namespace facula
