// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/csv_table.hpp>
#include <facula/tests/apps/cli/program_run.hpp>
#include <facula/tests/map/made_map.hpp>
#include <facula/tests/support/temporary_folder.hpp>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace facula {
namespace {

using Json = nlohmann::json;

class MapNavigation : public testing::Test {
 protected:
  void SetUp() override { hall_with_door().write(folder_ / "hall.bt"); }

  ProgramRun run(const std::string& line) const { return run_line(line, folder_.path()); }

  Json figures_of(const std::string& line) const {
    const ProgramRun done = run("facula " + line + " --json -");
    EXPECT_EQ(done.code, 0) << line << '\n' << done.err;
    const Json figures = Json::parse(done.out, nullptr, false);
    EXPECT_FALSE(figures.is_discarded()) << done.out;
    return figures;
  }

  TemporaryFolder folder_;
};

TEST_F(MapNavigation, PlansThroughTheDoorAndWritesAndDrawsThePath) {
  const Json figures = figures_of(
      "map plan hall.bt --from-m 0.5 0.5 1 --to-m 3.5 0.5 1 --radius-m 0.3 --flat "
      "--csv path.csv --picture path.png");
  const double length = figures.at("length_m");
  EXPECT_GT(length, 2 * std::hypot(1.5, 2.5));
  EXPECT_LT(length, 8);
  EXPECT_GE(figures.at("least_clearance_m"), 0.3);
  const CsvTable path = CsvTable::from_file(folder_ / "path.csv");
  EXPECT_EQ(path.rows(), figures.at("samples"));
  for (const double z : path.column({"z_m"})) EXPECT_EQ(z, 1);
  for (const double clearance : path.column({"clearance_m"})) EXPECT_GE(clearance, 0.3);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "path.png"));
  const Json report = figures_of("report --map hall.bt --path path.csv --out page.html");
  EXPECT_EQ(report.at("sections"), 2);
}

TEST_F(MapNavigation, PlansTheSamePathForTheSameSeed) {
  const std::string plan = "facula map plan hall.bt --from-m 0.5 0.5 1 --to-m 3.5 0.5 1 ";
  const ProgramRun same =
      run(plan + "--csv a.csv && " + plan + "--threads 1 --csv b.csv && cmp a.csv b.csv");
  EXPECT_EQ(same.code, 0) << same.out << same.err;
  EXPECT_EQ(run(plan + "--seed 2 --csv c.csv && cmp a.csv c.csv").code, 1);
}

TEST_F(MapNavigation, TakesPlacesWithCommasAndNamesWithoutUnits) {
  const ProgramRun same =
      run("facula map plan hall.bt --from-m 0.5 0.5 1 --to-m 3.5 0.5 1 --radius-m 0.3 --csv a.csv "
          "&& facula map plan hall.bt --from 0.5,0.5,1 --to=3.5,0.5,1 --radius 0.3 --csv b.csv "
          "&& cmp a.csv b.csv");
  EXPECT_EQ(same.code, 0) << same.out << same.err;
}

TEST_F(MapNavigation, AnswersQuestionsAboutPlacesRaysAndBoxes) {
  const Json place =
      figures_of("map query hall.bt --at-m 1 1 1 --radius-m 2 --unknown free").at("place");
  EXPECT_EQ(place.at("state"), "free");
  EXPECT_NEAR(place.at("obstacle_distance_m"), 1, 1e-9);
  const Json ray =
      figures_of("map query hall.bt --from-m 0.5 0.55 1.05 --to-m 1 0.55 1.05").at("ray");
  EXPECT_EQ(ray.at("end"), "occupied");
  EXPECT_NEAR(ray.at("distance_m"), 1.5, 1e-6);
  const Json box =
      figures_of("map query hall.bt --low-m 1.95 1.05 0.05 --high-m 2.15 1.25 3.95").at("box");
  EXPECT_EQ(box.at("occupied_cells"), 3 * 20);
  EXPECT_EQ(box.at("free_cells"), 2 * 3 * 20);
  EXPECT_EQ(box.at("unknown_cells"), 3 * 3 * 20);
}

TEST_F(MapNavigation, AnswersFilesOfPlacesAndRays) {
  std::ofstream(folder_ / "points.csv") << "x_m,y_m,z_m\n1,1,1\n2.05,1,1\n9,9,9\n";
  std::ofstream(folder_ / "rays.csv") << "x_m,y_m,z_m,to_x_m,to_y_m,to_z_m\n"
                                         "0.5,0.55,1.05,1,0.55,1.05\n0.5,0.5,1,0.5,0.5,2\n";
  const Json places = figures_of("map query hall.bt --points points.csv --csv states.csv");
  EXPECT_EQ(places.at("free_places"), 1);
  EXPECT_EQ(places.at("occupied_places"), 1);
  EXPECT_EQ(places.at("unknown_places"), 1);
  EXPECT_EQ(CsvTable::from_file(folder_ / "states.csv").texts("state"),
            (std::vector<std::string>{"free", "occupied", "unknown"}));
  const Json rays = figures_of("map query hall.bt --rays rays.csv --csv hits.csv");
  EXPECT_EQ(rays.at("stopped_rays"), 1);
  EXPECT_EQ(CsvTable::from_file(folder_ / "hits.csv").texts("end"),
            (std::vector<std::string>{"occupied", "unknown"}));
}

TEST_F(MapNavigation, RefusesInOneSentence) {
  const auto refuses = [&](const std::string& line, int code, const std::string& words) {
    expect_refused(run("facula " + line), code, words);
  };
  const std::string plan = "map plan hall.bt --from-m 0.5 0.5 1 --to-m ";
  refuses(plan + "2.05 1 1", 1, "expected the goal in free space, got (2.05, 1, 1) m inside");
  refuses(plan + "3.5 0.5 9", 1, "expected the goal within the map");
  refuses(plan + "3.5 0.5 1 --radius-m 0.45", 1, "but there is none");
  refuses(plan + "3.5 0.5 1 --radius-m 0", 1, "expected a radius above 0 m");
  refuses(plan + "3.5 0.5 1 --seed 0", 2, "--seed: expected a whole number from 1");
  refuses(plan + "3.5 0.5", 2, "--to-m: expected three numbers, got 2");
  refuses("map plan none.bt --from-m 0 0 0 --to-m 1 1 1", 1, "none.bt");
  refuses("map query hall.bt", 2, "expected a question");
  refuses("map query hall.bt --from-m 0 0 0", 2, "belong together");
  refuses("map query hall.bt --from-m 0 0 0 --to-m 0 0 0", 1, "a direction that is not 0");
  refuses("map query hall.bt --low-m 1 1 1 --high-m 0 0 0", 1, "lower corner is not above");
  refuses("map query hall.bt --at-m 1 1 1 --csv out.csv", 2, "--csv belongs to");
  refuses("report --path path.csv --out page.html", 1, "expected --map beside --path");
}

}  // namespace
}  // namespace facula
