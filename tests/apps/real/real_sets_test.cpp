// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/tests/apps/cli/program_run.hpp>
#include <facula/tests/support/real_data.hpp>
#include <facula/tests/support/temporary_folder.hpp>

#include <cmath>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace facula {
namespace {

using Json = nlohmann::json;

/// Runs a line with --json - and reads what it printed; fails the test when the run failed.
Json figures_of(const std::string& line, const TemporaryFolder& folder) {
  const ProgramRun run = run_line(line + " --json -", folder.path());
  EXPECT_EQ(run.code, 0) << line << "\n" << run.err;
  const Json figures = Json::parse(run.out, nullptr, false);
  EXPECT_FALSE(figures.is_discarded()) << run.out;
  return figures;
}

std::string capture(const std::string& set, const std::filesystem::path& frames) {
  return "'" + shipped_data("captures/" + set).string() + "' --frames '" + frames.string() + "'";
}

/// Distance [mm] between the two planes numbered so, as the program lists it; NaN when it does not.
double distance_between_planes(const Json& figures, int plane, int other) {
  for (const Json& row : figures.at("distances")) {
    if (row.at("plane") == plane && row.at("other") == other) return row.at("distance_mm");
  }
  return std::nan("");
}

TEST(RealSets, ThePotBecomesAMeshAndAMap) {
  FACULA_REQUIRE_REAL_DATA(frames, "laser/caltag_turntable_pot");
  const TemporaryFolder folder;
  const Json scan = figures_of(
      "facula extract " + capture("caltag_turntable_pot", frames) + " --out pot.pcd", folder);
  EXPECT_EQ(scan.at("frames"), 72);
  EXPECT_GE(scan.at("points").get<int>(), 28000);
  // The table is a disc of about 100 mm radius, the pot a cylinder of about 50 mm: 0.05 to 0.12 m2.
  const Json mesh = figures_of("facula mesh pot.pcd --out pot.ply", folder);
  EXPECT_GT(mesh.at("area_m2").get<double>(), 0.05);
  EXPECT_LT(mesh.at("area_m2").get<double>(), 0.12);
  const Json map = figures_of("facula map pot.pcd --resolution-mm 2 --out pot.bt", folder);
  EXPECT_GT(map.at("occupied_cells").get<int>(), 5000);
  EXPECT_GT(map.at("free_cells").get<int>(), 100000);
  const Json planes = figures_of("facula measure planes pot.pcd --inlier-mm 2", folder);
  EXPECT_LE(planes.at("planes").at(0).at("rms_mm").get<double>(), 0.55);
  EXPECT_GT(planes.at("planes").at(0).at("points").get<int>(), 8000);
}

/// Calipers: 4.69, 9.63 and 14.55 mm above the bed.
TEST(RealSets, TheStairsStandAtTheirHeights) {
  FACULA_REQUIRE_REAL_DATA(frames, "laser/printerbed_1mm_stairs");
  const TemporaryFolder folder;
  figures_of("facula extract " + capture("printerbed_1mm_stairs", frames) + " --out stairs.pcd",
             folder);
  const Json planes =
      figures_of("facula measure planes stairs.pcd --inlier-mm 0.3 --max-planes 4", folder);
  ASSERT_EQ(planes.at("plane_count"), 4);
  EXPECT_NEAR(distance_between_planes(planes, 1, 2), 14.55, 0.3);
  EXPECT_NEAR(distance_between_planes(planes, 1, 3), 9.63, 0.3);
  EXPECT_NEAR(distance_between_planes(planes, 1, 4), 4.69, 0.3);
}

TEST(RealSets, TheCorridorsWallsAreParallel) {
  FACULA_REQUIRE_REAL_DATA(scans, "range/3dtk-dat");
  const TemporaryFolder folder;
  const Json planes = figures_of("facula measure planes '" + (scans / "scan000.3d.gz").string() +
                                     "' --voxel-mm 50 --inlier-mm 30",
                                 folder);
  bool found = false;
  for (const Json& row : planes.at("distances")) {
    if (std::abs(row.at("distance_mm").get<double>() - 4750) > 30) continue;
    for (const Json& angle : planes.at("angles")) {
      if (angle.at("plane") != row.at("plane") || angle.at("other") != row.at("other")) continue;
      EXPECT_LT(angle.at("angle_deg").get<double>(), 0.5);
      found = true;
    }
  }
  EXPECT_TRUE(found) << planes.dump(1);
}

TEST(RealSets, TheCorridorBecomesAMapForRos) {
  FACULA_REQUIRE_REAL_DATA(scans, "range/3dtk-dat");
  const TemporaryFolder folder;
  const Json map =
      figures_of("facula map '" + scans.string() + "' --out c.bt --grid c.yaml", folder);
  EXPECT_EQ(map.at("scans"), 3);
  EXPECT_EQ(map.at("resolution_mm"), 50);
  const Json again = figures_of("facula info c.bt", folder);
  EXPECT_EQ(again.at("occupied_cells"), map.at("occupied_cells"));
  EXPECT_TRUE(std::filesystem::exists(folder / "c.pgm"));
}

TEST(RealSets, TheBunnyMeetsItsReference) {
  FACULA_REQUIRE_REAL_DATA(bunny, "range/stanford-bunny");
  const TemporaryFolder folder;
  const Json mesh = figures_of("facula mesh '" + (bunny / "data/bun.conf").string() +
                                   "' --voxel-mm 1 --out bunny.ply" + " --compare '" +
                                   (bunny / "reconstruction/bun_zipper.ply").string() + "'",
                               folder);
  EXPECT_LE(mesh.at("compare").at("median_mm").get<double>(), 0.08);
}

}  // namespace
}  // namespace facula
