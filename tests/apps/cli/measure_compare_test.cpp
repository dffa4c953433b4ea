// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/whole_file.hpp>
#include <facula/tests/apps/cli/measure_fixture.hpp>

#include <Eigen/Geometry>

namespace facula {
namespace {

TEST_F(Measure, CompareRefusesReferencesWithoutASurface) {
  write("points.pcd", points_alone({{0.2F, 0.2F, 1.003F}, {0.3F, 0.1F, 0.999F}}));
  write_text("empty.pcd", kNoPoints);
  write_mesh_text("good.ply", "0 0 1\n1 0 1\n0 1 1\n", "3 0 1 2\n");
  write_mesh_text("thin.ply", "0 0 1\n1 0 1\n2 0 1\n", "3 0 1 2\n");
  write_mesh_text("torn.ply", "0 0 1\n1 0 1\n0 1 1\n", "3 0 1 7\n");
  write_mesh_text("nan.ply", "nan 0 1\n1 0 1\n0 1 1\n", "3 0 1 2\n");
  const std::string to = "measure compare points.pcd --out result.ply --to ";
  expect_refused(to + "thin.ply", "no area");
  expect_refused(to + "torn.ply", "vertex 7");
  expect_refused(to + "nan.ply", "not a finite point");
  expect_refused(to + "empty.pcd", "no valid points");
  expect_refused("measure compare empty.pcd --to good.ply", "no valid points");
  expect_refused("measure compare points.pcd --to good.ply --max-mm 0.001 --picture result.png",
                 "got none of 2");
  const Json figures = figures_of("compare points.pcd --to good.ply");
  EXPECT_EQ(figures.at("reference"), "a mesh");
  EXPECT_NEAR(figures.at("most_mm").get<double>(), 3, 1e-3);
  EXPECT_NEAR(figures.at("least_mm").get<double>(), -1, 1e-3);
}

TEST_F(Measure, CompareReadsEveryFormatOfMeshes) {
  write("points.pcd", points_alone({{0.2F, 0.2F, 1.003F}, {0.3F, 0.1F, 0.999F}}));
  const TriangleMesh mesh{{{0, 0, 1}, {1, 0, 1}, {0, 1, 1}}, {{0, 1, 2}}, {}, {}};
  for (const std::string name : {"mesh.ply", "mesh.obj", "mesh.stl", "mesh.off", "mesh.glb"}) {
    write_mesh(folder_ / name, mesh);
    const Json to_mesh = figures_of("compare points.pcd --to " + name);
    EXPECT_EQ(to_mesh.at("reference"), "a mesh") << name;
    EXPECT_NEAR(to_mesh.at("most_mm").get<double>(), 3, 1e-3) << name;
    const Json corners = figures_of("compare " + name + " --to mesh.ply");
    EXPECT_EQ(corners.at("count"), 3) << name;
    EXPECT_NEAR(corners.at("max_mm").get<double>(), 0, 1e-3) << name;
  }
}

TEST_F(Measure, CompareToPointsWithoutASurfaceGivesDistancesAndSaysSo) {
  write("points.pcd", points_alone({{1, 2, 3.5F}}));
  write("spot.pcd", points_alone(std::vector<Eigen::Vector3f>(50, {1, 2, 3})));
  write("one.pcd", points_alone({{1, 2, 3}}));
  write_mesh_text("faceless.ply", "1 2 3\n1 2 3\n1 2 3\n", "");
  for (const std::string reference : {"spot.pcd", "one.pcd", "faceless.ply"}) {
    const Json figures = figures_of("compare points.pcd --to " + reference);
    EXPECT_EQ(figures.at("reference"), "points") << reference;
    EXPECT_EQ(figures.at("has_sign"), false) << reference;
    EXPECT_NEAR(figures.at("max_mm").get<double>(), 500, 1e-3) << reference;
    EXPECT_NE(figures.at("note_1").get<std::string>().find("nearest point"), std::string::npos);
  }
}

TEST_F(Measure, CompareTakesManyPointsInOnePlaceAsOne) {
  // A plate askew to all axes, 3 mm behind the points as seen from the origin.
  const Eigen::Vector3f normal = Eigen::Vector3f(-2, -1, -1.5F).normalized();
  const Eigen::Vector3f u = normal.unitOrthogonal();
  const Eigen::Vector3f v = normal.cross(u);
  std::vector<Eigen::Vector3f> plate;
  std::vector<Eigen::Vector3f> points;
  for (int i = 0; i < 400; ++i) {
    const float a = 0.01F * static_cast<float>(i % 20);
    const float b = 0.01F * static_cast<float>(i / 20);
    plate.insert(plate.end(), 30, Eigen::Vector3f(-2 * normal + a * u + b * v));
    points.emplace_back(plate.back() + 0.002F * u + 0.004F * v + 0.003F * normal);
  }
  write("plate.pcd", points_alone(plate));
  write("points.pcd", points_alone(points));
  const Json figures = figures_of("compare points.pcd --to plate.pcd");
  EXPECT_EQ(figures.at("has_sign"), true);
  EXPECT_NEAR(figures.at("least_mm").get<double>(), 3, 1e-2);
  EXPECT_NEAR(figures.at("most_mm").get<double>(), 3, 1e-2);
}

TEST_F(Measure, TheHistogramHoldsEveryPointThatWasCompared) {
  write("room.pcd", made_room());
  PointCloud stray = made_room();
  stray.points.front() = {-50, 0, 0};  // towards the sensor
  write("stray.pcd", stray);
  const Json figures = figures_of("compare stray.pcd --to room.pcd --csv histogram.csv");
  std::size_t listed = 0;
  for (const Json& row : figures.at("histogram")) listed += row.at("points").get<std::size_t>();
  EXPECT_EQ(listed, figures.at("count").get<std::size_t>());
  EXPECT_TRUE(figures.at("histogram").back().at("to_mm").is_null());
}

TEST_F(Measure, TheReportShowsThePlanesOfMeasurePlanes) {
  const ProgramRun made =
      run("facula simulate data/scenes/furnished_room.toml --rig data/rigs/head_fs1500.toml "
          "--step-deg 6 --position-mm -1500 -300 1100 --out room && facula extract "
          "room --out room.pcd "
          "&& facula report --scan room.pcd --out room.html");
  ASSERT_EQ(made.code, 0) << made.err;
  const std::string html = read_whole_file(folder_ / "room.html");
  const Json planes = figures_of("planes room.pcd").at("planes");
  ASSERT_GE(planes.size(), 2U);
  std::size_t at = 0;
  for (const Json& plane : planes) {
    at = html.find(">" + std::to_string(plane.at("points").get<std::size_t>()) + "<", at);
    ASSERT_NE(at, std::string::npos) << plane;
    ++at;
  }
}

}  // namespace
}  // namespace facula
