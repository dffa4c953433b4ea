// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/map/navigation_grid.hpp>
#include <facula/tests/apps/cli/program_run.hpp>
#include <facula/tests/map/drawn_map.hpp>
#include <facula/tests/support/temporary_folder.hpp>

#include <algorithm>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace facula {
namespace {

using Json = nlohmann::json;

/// A room of 4 m x 3 m x 2.5 m in cells of 5 cm, its floor's cells from 0.95 to 1 m; a post in its
/// middle; a niche of 1 m x 0.4 m x 1 m behind its wall at x = 4 m that nobody saw.
OccupancyMap room() {
  DrawnMap drawn(0.05);
  drawn.occupy({{80, 19, 24}, {89, 41, 46}});
  drawn.room({{0, 0, 20}, {80, 60, 70}});
  drawn.occupy({{40, 30, 20}, {42, 32, 50}});
  drawn.forget({{80, 20, 25}, {88, 40, 45}});
  return drawn.map();
}

class MapOutputs : public testing::Test {
 protected:
  MapOutputs() { room().write(folder_ / "room.ot"); }

  Json figures_of(const std::string& options) const {
    const ProgramRun done = run_line("facula map room.ot --json - " + options, folder_.path());
    EXPECT_EQ(done.code, 0) << done.err;
    EXPECT_EQ(done.err, "");
    return Json::parse(done.out, nullptr, false);
  }

  void expect_refused(const std::string& line, int code, const std::string& words) const {
    facula::expect_refused(run_line("facula map " + line, folder_.path()), code, words);
    EXPECT_FALSE(has_file_like(folder_.path(), "result")) << line;
  }

  TemporaryFolder folder_;
};

TEST_F(MapOutputs, CountHeightsFromTheFloorTheyFind) {
  const Json figures = figures_of("--above-floor --grid grid.yaml --max-height-m 1");
  EXPECT_NEAR(figures.at("floor").at("floor_height_m").get<double>(), 0.975, 1e-9);
  EXPECT_NEAR(figures.at("floor").at("floor_area_m2").get<double>(), 4 * 3 - 0.01, 1e-9);
  const Json heights = figures.at("grid").at("heights_m");
  EXPECT_NEAR(heights[0].get<double>(), 0.975 + 0.1, 1e-9);
  EXPECT_NEAR(heights[1].get<double>(), 0.975 + 1, 1e-9);
  // Walls one cell thick around, the walls of the niche, the post of 2 x 2 cells.
  const NavigationGrid grid = read_navigation_grid(folder_ / "grid.yaml");
  EXPECT_EQ(std::count(grid.cells.begin(), grid.cells.end(), NavigationGrid::kFree), 80 * 60 - 4);
  EXPECT_EQ(figures.at("grid").at("grid_free_cells"), 80 * 60 - 4);
}

TEST_F(MapOutputs, CountHeightsFromTheFloorTheyAreTold) {
  const Json figures =
      figures_of("--above-floor --floor-m 1.2 --grid grid.yaml --min-height-m 0 --max-height-m 1");
  EXPECT_NEAR(figures.at("floor").at("floor_height_m").get<double>(), 1.2, 1e-9);
  EXPECT_FALSE(figures.at("floor").contains("floor_area_m2"));
  EXPECT_NEAR(figures.at("grid").at("heights_m")[0].get<double>(), 1.25, 1e-9);
}

TEST_F(MapOutputs, TakeWorldHeightsWithoutThat) {
  const Json figures = figures_of("--grid grid.yaml --min-height-m 1.05 --max-height-m 2");
  EXPECT_FALSE(figures.contains("floor"));
  EXPECT_NEAR(figures.at("grid").at("heights_m")[0].get<double>(), 1.05, 1e-9);
}

TEST_F(MapOutputs, WriteGridsInTheModeAskedFor) {
  const std::string above = "--above-floor --grid ";
  EXPECT_EQ(figures_of(above + "s.yaml --grid-mode scale").at("grid").at("mode"), "scale");
  EXPECT_TRUE(std::filesystem::exists(folder_ / "s.png"));
  figures_of(above + "r.yaml --grid-mode raw --inflate-m 0.2");
  const auto raw = read_navigation_grid(folder_ / "r.yaml").occupancy;
  EXPECT_GT(std::count(raw.begin(), raw.end(), 12), 1000);   // free: clamped at 0.1192
  EXPECT_GT(std::count(raw.begin(), raw.end(), 100), 1000);  // near the walls
}

TEST_F(MapOutputs, SayFromWhereTheNicheCanBeSeen) {
  const Json figures = figures_of("--frontiers next.csv --frontiers next.png");
  const Json places = figures.at("frontiers").at("next_scans");
  ASSERT_GE(places.size(), 1U);
  EXPECT_NEAR(places[0].at("z_m").get<double>(), 0.975 + 1.2, 1e-9);
  EXPECT_NEAR(places[0].at("volume_m3").get<double>(), 0.4, 0.1);
  EXPECT_NEAR(places[0].at("region_x_m").get<double>(), 3.9, 0.2);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "next.png"));
  EXPECT_TRUE(std::filesystem::exists(folder_ / "next.csv"));
}

TEST_F(MapOutputs, WriteHeightMapsAsFloatsAndAsPictures) {
  const Json figures = figures_of("--above-floor --height-map top.tif --height-map top.png");
  const Json heights = figures.at("height_map");
  EXPECT_NEAR(heights.at("height_map_limit_m").get<double>(), 0.975 + 1.5, 1e-9);
  EXPECT_NEAR(heights.at("height_map_range_m")[0].get<double>(), 1.0, 1e-6);
  EXPECT_NEAR(heights.at("height_map_range_m")[1].get<double>(), 2.45, 1e-6);
  for (const char* name : {"top.tif", "top.tif.yaml", "top.png"}) {
    EXPECT_TRUE(std::filesystem::exists(folder_ / name)) << name;
  }
}

TEST_F(MapOutputs, RefuseWhatCannotBe) {
  expect_refused("room.ot", 2, "--frontiers");
  expect_refused("room.ot --grid result.yaml --verify", 2, "--verify needs");
  expect_refused("room.ot --frontiers result.png --height-map result.png", 2, "'result.png'");
  expect_refused("room.ot --grid result.png", 1, ".yaml");
  expect_refused("room.ot --resolution-mm 20 --out result.ot", 2, "keeps its cells");
  expect_refused("room.ot --grid result.yaml --floor-m 1", 2, "--floor-m belongs to");
  expect_refused("room.ot room.ot --out result.ot", 1, "facula map merge");
  expect_refused("room.ot --grid result.yaml --grid-mode grey", 2, "trinary");
  expect_refused("room.ot --frontiers result.csv --scanner-height-m 9", 1, "tripod");
  expect_refused("room.ot --height-map result.tif --max-height-m -9 --min-height-m -10", 1, "-9 m");
}

TEST_F(MapOutputs, SayThatAMapHasNoFloor) {
  DrawnMap wall(0.05);
  wall.occupy({{0, 0, 0}, {1, 40, 40}});
  wall.free({{1, 0, 0}, {40, 40, 40}});
  wall.map().write(folder_ / "wall.bt");
  expect_refused("wall.bt --above-floor --grid result.yaml", 1, "no floor");
  expect_refused("wall.bt --frontiers result.csv", 1, "no floor");
}

}  // namespace
}  // namespace facula
