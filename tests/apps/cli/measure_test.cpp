// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/tests/apps/cli/measure_fixture.hpp>

namespace facula {
namespace {

TEST_F(Measure, KnownAnglesAndDistancesLieWithinTwiceTheStatedSigma) {
  write("room.pcd", made_room());
  const Json planes = figures_of("planes room.pcd").at("planes");
  ASSERT_EQ(planes.size(), 4U);
  const double half = std::sqrt(0.75);
  const int floor = plane_like(planes, {0, 0, 1}, -1000);
  const int step = plane_like(planes, {0, 0, 1}, -900);
  const int wall = plane_like(planes, {1, 0, 0}, 3300);
  // Through (0, -3, -0.9), rising towards -y.
  const int ramp = plane_like(planes, {0, 0.5, half}, 1000 * (-3 * 0.5 - 0.9 * half));
  const Json angles = figures_of("angles room.pcd").at("angles");
  const auto expect_angle = [&](int a, int b, double truth) {
    const Json& row = row_of(angles, std::min(a, b), std::max(a, b));
    const double sigma = row.at("angle_sigma_deg");
    EXPECT_NEAR(row.at("angle_deg").get<double>(), truth, 2 * sigma);
    EXPECT_LT(sigma, 0.02);
  };
  expect_angle(floor, wall, 90);
  expect_angle(step, wall, 90);
  expect_angle(floor, ramp, 30);
  expect_angle(ramp, step, 30);
  const Json distances = figures_of("distance room.pcd").at("distances");
  ASSERT_EQ(distances.size(), 1U);
  const Json& apart = row_of(distances, std::min(floor, step), std::max(floor, step));
  const double sigma = apart.at("distance_sigma_mm");
  EXPECT_NEAR(apart.at("distance_mm").get<double>(), 100, 2 * sigma);
  EXPECT_LT(sigma, 0.2);
}

TEST_F(Measure, AFarWallIsMeasuredByAllItsPointsHoweverNoisy) {
  // The noise of most points says how far points lie from planes, the far wall's own is 15 times
  // it.
  PointCloud room = made_room();
  Random random(9);
  add_plate(room, {7, -1.5, -0.8}, edges({0.3, 3, 0}, {0, 0, 2}), random, 15 * kNoise);
  write("room.pcd", room);
  const Json figures = figures_of("planes room.pcd");
  EXPECT_LT(figures.at("inlier_mm"), 6);
  const Eigen::Vector3d normal = Eigen::Vector3d(3, -0.3, 0).normalized();
  const int far =
      plane_like(figures.at("planes"), normal, 1000 * normal.dot(Eigen::Vector3d(7, -1.5, 0)));
  const Json& wall = figures.at("planes").at(static_cast<std::size_t>(far - 1));
  EXPECT_GT(wall.at("points"), 3550);
  EXPECT_NEAR(wall.at("rms_mm").get<double>(), 15, 1);
  const Eigen::Vector3d found(wall.at("normal_x"), wall.at("normal_y"), wall.at("normal_z"));
  const double away = std::atan2(found.cross(normal).norm(), std::abs(found.dot(normal)));
  EXPECT_LT(away * 180 / std::acos(-1.0), 3 * wall.at("normal_sigma_deg").get<double>());
  // All of it was taken, so nothing was cut; a band that is asked for does cut.
  EXPECT_FALSE(figures_of("flatness room.pcd --trials 20").contains("cut_planes"));
  EXPECT_TRUE(figures_of("flatness room.pcd --trials 20 --inlier-mm 6").contains("cut_planes"));
}

TEST_F(Measure, APointGivenTwiceTellsNothingNewOfAPlane) {
  const PointCloud room = made_room();
  write("room.pcd", room);
  const Json figures = figures_of("planes room.pcd room.pcd");
  EXPECT_EQ(figures.at("doubles_removed"), room.size());
  ASSERT_EQ(figures.at("planes").size(), 4U);
  const std::size_t made = room.size() / 4;
  for (const Json& plane : figures.at("planes")) {
    EXPECT_LE(plane.at("points"), made);
    EXPECT_GT(plane.at("points"), made * 9 / 10);
  }
  const int floor = plane_like(figures.at("planes"), {0, 0, 1}, -1000);
  const int step = plane_like(figures.at("planes"), {0, 0, 1}, -900);
  EXPECT_NE(floor, step);
}

TEST_F(Measure, APlaneIsTheSamePlaneInEveryCommand) {
  write("room.pcd", made_room());
  const Json planes = figures_of("planes room.pcd --csv planes.csv");
  const Json angles = figures_of("angles room.pcd");
  const Json flatness = figures_of("flatness room.pcd --trials 20");
  const Json distances = figures_of("distance room.pcd --parallel-deg 40");
  ASSERT_EQ(flatness.at("flatness").size(), planes.at("planes").size());
  for (std::size_t i = 0; i < planes.at("planes").size(); ++i) {
    const Json& plane = planes.at("planes")[i];
    EXPECT_EQ(plane.at("plane"), flatness.at("flatness")[i].at("plane"));
    EXPECT_EQ(plane.at("points"), flatness.at("flatness")[i].at("points"));
    EXPECT_EQ(plane.at("plane"), angles.at("plumb")[i].at("plane"));
  }
  for (const Json& row : planes.at("angles")) {
    const Json& same = row_of(angles.at("angles"), row.at("plane"), row.at("other"));
    EXPECT_EQ(row.at("angle_deg"), same.at("angle_deg"));
    EXPECT_EQ(row.at("angle_sigma_deg"), same.at("angle_sigma_deg"));
  }
  for (const Json& row : planes.at("distances")) {
    const Json& same = row_of(distances.at("distances"), row.at("plane"), row.at("other"));
    EXPECT_EQ(row.at("distance_mm"), same.at("distance_mm"));
  }
}

TEST_F(Measure, AnglesBetweenScansHoldTheUncertaintyOfTheirPoses) {
  Random random(4);
  PointCloud floor;
  PointCloud wall;
  add_plate(floor, {1.0, -1.5, -1.0}, edges({2, 0, 0}, {0, 2.0, 0}), random);
  add_plate(wall, {3.3, -1.5, -0.8}, edges({0, 3, 0}, {0, 0, 2}), random);
  write("floor.pcd", floor);
  write("wall.pcd", wall);
  // The wall's scan may have turned by 1 mrad about any axis: so may the angle.
  write_text("poses.toml",
             "[[scan]]\nfile = 'floor.pcd'\n[[scan]]\nfile = 'wall.pcd'\ncovariance_m_rad = "
             "[0,0,0,0,0,0, 0,0,0,0,0, 0,0,0,0, 1e-6,0,0, 1e-6,0, 1e-6]\n");
  const auto sigma_of = [this](const std::string& line) {
    return figures_of("angles " + line).at("angles").at(0).at("angle_sigma_deg").get<double>();
  };
  const double noise = sigma_of("floor.pcd wall.pcd");
  EXPECT_LT(noise, 0.005);
  const double turned = 0.001 * 180 / std::acos(-1.0);
  EXPECT_NEAR(sigma_of("poses.toml"), std::hypot(turned, noise), 1e-4);
  EXPECT_NEAR(sigma_of("poses.toml --voxel-mm 100"), turned, 1e-3);
  EXPECT_EQ(figures_of("angles poses.toml").at("unsure_poses"), 1);
}

TEST_F(Measure, AZoneThatIsNeitherSquareNorParallelIsNullNotNan) {
  write("room.pcd", made_room());
  const ProgramRun measured =
      run("facula measure angles room.pcd --csv angles.csv --json - && cat angles.csv");
  ASSERT_EQ(measured.code, 0) << measured.err;
  EXPECT_EQ(measured.out.find("nan"), std::string::npos);
  EXPECT_EQ(measured.out.find("inf,"), std::string::npos);
  const Json figures = figures_of("angles room.pcd");
  std::size_t without = 0;
  for (const Json& row : figures.at("angles")) {
    const bool none = row.at("tolerance") == "-";
    EXPECT_EQ(row.at("zone_mm").is_null(), none);
    EXPECT_EQ(row.at("zone_points_mm").is_null(), none);
    without += none ? 1 : 0;
  }
  EXPECT_EQ(without, 2U);  // ramp and floor, ramp and step
}

TEST_F(Measure, FlatnessOfAFlatPlateIsThatOfItsNoise) {
  Random random(8);
  PointCloud plate;
  add_plate(plate, {2, -0.5, -0.5}, edges({0, 1, 0}, {0, 0, 1}), random);
  write("plate.pcd", plate);
  const Json row = figures_of("flatness plate.pcd --whole").at("flatness").at(0);
  const double total = row.at("flt_t_mm");
  EXPECT_NEAR(
      total, row.at("noise_flt_t_mm").get<double>(), 2 * row.at("flt_t_sigma_mm").get<double>());
  EXPECT_LT(total, row.at("noise_flt_t_p95_mm").get<double>());
  EXPECT_NEAR(row.at("flt_q_mm").get<double>(), 1, 0.1);
  EXPECT_LE(row.at("minimum_zone_mm").get<double>(), total);
}

TEST_F(Measure, FlatnessOfASaddleIsTheClosedForm) {
  // z = a x y on a square about 0: the least-squares plane is z = 0.
  std::vector<Eigen::Vector3f> points;
  for (int i = -20; i <= 20; ++i) {
    for (int j = -20; j <= 20; ++j) {
      const auto x = static_cast<float>(i) / 20;
      const auto y = static_cast<float>(j) / 20;
      points.emplace_back(x, y, 0.002F * x * y);
    }
  }
  write("saddle.pcd", points_alone(points));
  const Json row = figures_of("flatness saddle.pcd --whole").at("flatness").at(0);
  EXPECT_NEAR(row.at("flt_t_mm").get<double>(), 4, 1e-4);
  EXPECT_NEAR(row.at("flt_p_mm").get<double>(), 2, 1e-4);
  EXPECT_NEAR(row.at("flt_v_mm").get<double>(), 2, 1e-4);
  EXPECT_NEAR(row.at("flt_q_mm").get<double>(), 2 * 0.35, 1e-4);  // mean of x^2: 0.35 for 41 places
  EXPECT_TRUE(row.at("flt_t_sigma_mm").is_null());
}

TEST_F(Measure, StairsHaveTheirStepsWithinTwiceTheStatedSigma) {
  write("stairs.pcd", made_stairs());
  const Json pieces = figures_of("profile stairs.pcd --normal 0 1 0 --csv pieces.csv").at("pieces");
  std::vector<std::pair<double, double>> steps;
  for (const Json& piece : pieces) {
    if (piece.at("points").get<int>() < 1000 || piece.at("step_mm").is_null()) continue;
    steps.emplace_back(piece.at("step_mm"), piece.at("step_sigma_mm"));
  }
  std::sort(steps.begin(), steps.end());
  ASSERT_GE(steps.size(), 3U) << pieces.dump(1);
  const std::vector<double> truths{4.69, 9.63, 14.55};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto& [step, sigma] = steps[steps.size() - 3 + i];
    EXPECT_NEAR(step, truths[i], 2 * sigma);
    EXPECT_LT(sigma, 0.05);
  }
}

TEST_F(Measure, PointsThatHoldNoPlaneAreRefusedInOneSentence) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  std::vector<Eigen::Vector3f> line;
  std::vector<Eigen::Vector3f> blob;
  Random random(2);
  for (int i = 0; i < 2000; ++i) {
    line.emplace_back(1 + 0.001F * static_cast<float>(i), 2, 3);
    blob.emplace_back(
        Eigen::Vector3d(random.normal(), random.normal(), random.normal()).cast<float>());
  }
  write_text("empty.pcd", kNoPoints);
  write("one.pcd", points_alone({{1, 2, 3}}));
  write("line.pcd", points_alone(line));
  write("spot.pcd", points_alone(std::vector<Eigen::Vector3f>(2000, {1, 2, 3})));
  write("nan.pcd", points_alone(std::vector<Eigen::Vector3f>(2000, {nan, nan, nan})));
  write("blob.pcd", points_alone(blob));
  // All four search for planes alike, so planes stands for the others.
  const auto refused = [this](const std::string& input, const std::string& words) {
    expect_refused("measure " + input + " --csv result.csv", words);
  };
  refused("planes empty.pcd", "no valid points");
  refused("planes nan.pcd", "no valid points");
  refused("planes one.pcd", "no plane fits");
  refused("planes blob.pcd", "expected a plane of 500 points");
  refused("angles line.pcd", "no plane fits");
  refused("distance spot.pcd --inlier-mm 5", "no plane fits");
  refused("flatness line.pcd --inlier-mm 5", "no plane fits");
  refused("flatness one.pcd --whole", "at least 3 points");
  refused("flatness line.pcd --whole", "one line");
  const std::string thick = " --thickness-mm 9000";
  refused("profile empty.pcd", "no valid points");
  refused("profile one.pcd" + thick, "straight piece");
  refused("profile spot.pcd" + thick, "one spot");
  expect_refused("measure profile line.pcd --shape circle" + thick, "one line");
  expect_refused("measure profile one.pcd --shape ball", "at least 4 points");
  expect_refused("measure profile line.pcd --shape ball", "expected a sphere");
  expect_refused("measure profile spot.pcd --shape rod", "expected a cylinder");
}

TEST_F(Measure, SomePointsThatAreNotNumbersAreLeftOut) {
  PointCloud room = made_room();
  const std::size_t points = room.size();
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (std::size_t i = 0; i < points; i += 10) room.points[i].setConstant(nan);
  write("room.pcd", room);
  const Json figures = figures_of("planes room.pcd");
  EXPECT_EQ(figures.at("points").get<std::size_t>(), points - points / 10);
  EXPECT_EQ(figures.at("planes").size(), 4U);
}

TEST_F(Measure, SweepsOfAListAreMeasuredApart) {
  // A wall ahead, seen on two sweeps whose tilts differ by the play of the gears.
  std::string rows = "range_mm,pan_deg,tilt_deg\n";
  for (int pan = 0; pan < 40; ++pan) {
    for (int step = 0; step < 40; ++step) {
      const bool rising = pan % 2 == 0;
      const int tilt = 60 + (rising ? step : 39 - step);
      const double radians = std::acos(-1.0) / 180;
      const double truth = (tilt + (rising ? 0.0 : 4.0)) * radians;
      const double range = 2000 / (std::sin(truth) * std::cos((pan - 20) * radians));
      rows += std::to_string(range) + "," + std::to_string(pan - 20) + "," + std::to_string(tilt) +
              "\n";
    }
  }
  write_text("list.csv", rows);
  const Json both = figures_of("planes list.csv --min-points 200 --inlier-mm 150");
  EXPECT_NE(both.at("note_1").get<std::string>().find("--sweeps"), std::string::npos);
  const Json rising = figures_of("planes list.csv --min-points 200 --sweeps rising");
  EXPECT_EQ(rising.at("points"), 800);
  EXPECT_LT(rising.at("planes").at(0).at("rms_mm").get<double>(), 0.1);
  EXPECT_FALSE(rising.contains("note_1"));
  write("room.pcd", made_room());
  expect_refused("measure planes room.pcd --sweeps rising", "leave it out");
}

}  // namespace
}  // namespace facula
