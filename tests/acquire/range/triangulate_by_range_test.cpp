// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/random.hpp>
#include <facula/acquire/range/polar_solution.hpp>
#include <facula/acquire/range/range_design.hpp>
#include <facula/acquire/range/spot_range.hpp>
#include <facula/acquire/rig/rig_file.hpp>
#include <facula/acquire/triangulate/triangulate.hpp>
#include <facula/tests/support/matchers.hpp>
#include <facula/tests/support/real_data.hpp>
#include <facula/tests/support/temporary_folder.hpp>

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace facula {
namespace {

/// A head with an upright sheet, its lens without distortion; the sheet is then a hyperbola.
Rig sheet_rig() {
  Rig rig = read_rig(shipped_data("rigs/head_fs1500.toml"));
  rig.camera.k1 = 0;
  rig.camera.k2 = 0;
  return rig;
}

/// n . z (x, y, 1) = D with n_y = 0: z = (D fx / n_x) / (px - cx + fx n_z / n_x).
Rig range_rig(const Rig& sheet) {
  const LaserPlane& laser = sheet.lasers.front();
  const Camera& camera = sheet.camera;
  Rig rig = sheet;
  rig.lasers.clear();
  RangeModel model;
  model.slope = -laser.distance * camera.fx / laser.normal.x();
  model.vanishing = camera.cx - camera.fx * laser.normal.z() / laser.normal.x();
  rig.range = model;
  return rig;
}

TEST(TriangulateByRange, EqualsRayAndSheetInEveryRow) {
  const Rig sheet = sheet_rig();
  const Rig range = range_rig(sheet);
  range.check();
  for (const double row : {0.0, 100.0, 239.5, 479.0}) {
    for (const double px : {200.0, 319.5, 450.0, 639.0}) {
      const auto by_sheet = triangulate(sheet, 0, {px, row}, 0.1);
      const auto by_range = triangulate(range, 0, {px, row}, 0.1);
      ASSERT_TRUE(by_sheet && by_range) << px;
      EXPECT_TRUE(is_near_point(by_range->x_in_camera, by_sheet->x_in_camera, 1e-12));
      // The sheet's sigma is a difference over a whole pixel.
      EXPECT_NEAR(by_range->sigma / by_sheet->sigma, 1, 1e-3);
    }
  }
}

TEST(TriangulateByRange, SigmaIsTheScatterItCauses) {
  Rig rig = range_rig(sheet_rig());
  std::vector<CompensationTable::Plane> planes;
  for (const double position : {250.0, 300.0, 350.0, 400.0}) {
    CompensationTable::Plane plane{position, {}};
    for (int u = 0; u < 480; ++u) {
      // A shift that changes by a tenth of the way: enough to be seen in the sigma.
      plane.measured.push_back(position + 0.1 * (position - 325) + 2e-5 * (u - 240) * (u - 240));
    }
    planes.push_back(std::move(plane));
  }
  rig.compensation = CompensationTable(planes, 5);
  rig.check();
  Random random(11);
  const Eigen::Vector2d pixel(333, 77);
  const auto point = triangulate(rig, 0, pixel, 0.2);
  ASSERT_TRUE(point.has_value());
  double squares = 0;
  constexpr int kTrials = 4000;
  for (int i = 0; i < kTrials; ++i) {
    const auto other = triangulate(rig, 0, pixel + Eigen::Vector2d(0.2 * random.normal(), 0), 0.2);
    ASSERT_TRUE(other.has_value());
    squares +=
        std::pow((other->x_in_camera - point->x_in_camera).dot(point->x_in_camera.normalized()), 2);
  }
  EXPECT_NEAR(std::sqrt(squares / kTrials) / point->sigma, 1, 0.05);
}

TEST(TriangulateByRange, SeesNothingBeyondInfinity) {
  const Rig rig = range_rig(sheet_rig());
  EXPECT_FALSE(triangulate(rig, 0, {rig.range->vanishing - 1, 100}, 0.1).has_value());
  EXPECT_NE(error_of([&] {
              triangulate(rig, 1, {300, 100}, 0.1);
            }).find("below 1"),
            std::string::npos);
}

TEST(RigFile, KeepsTheCalibrationsWithoutABoard) {
  Rig rig = range_rig(sheet_rig());
  rig.range->bend = 3e-7;
  rig.range->centre = 319.5;
  rig.range->lowest_px = 100;
  rig.range->highest_px = 400;
  rig.range->covariance << 0.01, 0.001, 1e-9, 0.001, 0.04, 2e-9, 1e-9, 2e-9, 1e-16;
  rig.compensation = CompensationTable(
      {{100, std::vector<double>(480, 101.25)}, {200, std::vector<double>(480, 199.0 + 1.0 / 3)}},
      7);
  rig.profile_polynomial = ProfilePolynomial{{0.001, 0.002, 0.0005}, 105, 35, 70, 140};
  rig.profile_projection = SheetProjection{};
  rig.profile_projection->image_from_sheet << 6000, 10, 320, -20, 5000, 240, 0.1, 0.9, 1;
  rig.two_line = TwoLineHead{0.1, 0.001, 1.33};
  const TemporaryFolder folder;
  write_rig(folder / "rig.toml", rig);
  const Rig copy = read_rig(folder / "rig.toml");
  ASSERT_TRUE(copy.range && copy.compensation && copy.profile_polynomial &&
              copy.profile_projection && copy.two_line);
  EXPECT_NEAR(copy.range->slope, rig.range->slope, 1e-13);
  EXPECT_EQ(copy.range->bend, rig.range->bend);
  EXPECT_EQ(copy.range->highest_px, 400);
  EXPECT_TRUE(copy.range->covariance.isApprox(rig.range->covariance, 1e-12));
  EXPECT_EQ(copy.compensation->window(), 7);
  EXPECT_EQ(copy.compensation->planes()[1].measured, rig.compensation->planes()[1].measured);
  EXPECT_NEAR(copy.profile_polynomial->value(111.5), rig.profile_polynomial->value(111.5), 1e-17);
  EXPECT_TRUE(copy.profile_projection->image_from_sheet.isApprox(
      rig.profile_projection->image_from_sheet, 1e-14));
  EXPECT_EQ(copy.two_line->divergence, 0.001);
  EXPECT_NE(error_of([&] {
              Rig wrong = rig;
              wrong.compensation = CompensationTable({{1, {1, 1}}}, 0);
              wrong.check();
            }).find("compensation table of 480 lines"),
            std::string::npos);
}

// Source A.

TEST(SpotRange, EqualsRayAndSheetOnAndOffTheAxis) {
  // A sheet parallel to the camera's axis, 250 mm beside it; f = 6 mm, p = 10 um.
  const SpotRange spot{.focal_length = 0.006,
                       .baseline = 0.25,
                       .pixel_size = 1e-5,
                       .offset = -0.003195,
                       .laser_angle = std::numbers::pi / 2,
                       .middle_row = 239.5};
  spot.check();
  Rig rig = sheet_rig();
  rig.lasers.front().normal = {1, 0, 0};
  rig.lasers.front().distance = 0.25;
  for (const double px : {400.0, 500.0, 639.0}) {
    for (const double row : {0.0, 239.5, 479.0}) {
      const auto point = triangulate(rig, 0, {px, row}, 0.1);
      ASSERT_TRUE(point.has_value());
      const Eigen::Vector3d x = point->x_in_camera;
      EXPECT_NEAR(spot.perpendicular(px), x.z(), 1e-12);  // (1), (3)
      EXPECT_NEAR(spot.perpendicular_off_axis(px, row), std::hypot(x.y(), x.z()), 1e-12);  // (6)
    }
    const double dx = 1e-9;
    SpotRange moved = spot;
    moved.offset += dx;
    EXPECT_NEAR((moved.perpendicular(px) - spot.perpendicular(px)) / dx / spot.sensitivity(px),
                1,
                1e-5);  // (5)
  }
  SpotRange leaning = spot;
  leaning.laser_angle = 83 * std::numbers::pi / 180;
  EXPECT_NEAR(leaning.along_beam(500) * std::sin(leaning.laser_angle),
              leaning.perpendicular(500),
              1e-15);  // (2), (4)
}

// Source B.

TEST(PolarSolution, EqualsRayAndSheetSeenFromThePole) {
  const Rig rig = sheet_rig();
  const LaserPlane& laser = rig.lasers.front();
  // Baseline = the camera's x axis. The sheet n_x x + n_z z = D crosses it at x = D / n_x and leans
  // towards the camera by tan(alpha) = n_z / n_x.
  const double laser_at = laser.distance / laser.normal.x();
  const double pole_at = 0.03;
  const Rig range = range_rig(rig);
  const PolarSolution solution{.focal_length_px = rig.camera.fy,
                               .slope = -range.range->slope,
                               .vanishing = range.range->vanishing,
                               .direction = 1,
                               .middle_row = rig.camera.cy,
                               .laser_angle = std::atan2(laser.normal.z(), laser.normal.x()),
                               .pole_to_laser = laser_at - pole_at};
  solution.check();
  for (const double row : {0.0, 100.0, 239.5, 479.0}) {
    for (const double px : {190.0, 250.0, 319.5, 450.0, 639.0}) {
      const auto point = triangulate(rig, 0, {px, row}, 0.1);
      ASSERT_TRUE(point.has_value());
      const Eigen::Vector3d from_pole = point->x_in_camera - Eigen::Vector3d(pole_at, 0, 0);
      const PolarSolution::Polar polar = solution.solve(px, row);
      EXPECT_NEAR(polar.range, from_pole.norm(), 1e-12);
      EXPECT_NEAR(polar.yaw, std::atan2(from_pole.x(), from_pole.z()), 1e-9);
      EXPECT_TRUE(is_near_point(PolarSolution::cartesian(polar), from_pole, 1e-8));
    }
  }
  EXPECT_TRUE(std::isnan(solution.solve(solution.vanishing - 1, 100).range));
}

TEST(RangeDesign, FollowsThePrintedCurves) {
  const RangeDesign green{.fs = 760e-6};
  const RangeDesign red{.fs = 1500e-6};
  EXPECT_NEAR(green.nearest(), 0.198, 5e-4);  // "the distance within 20 cm"
  EXPECT_NEAR(red.nearest(), 0.39, 1e-3);     // "a minimum distance of 40 cm"
  EXPECT_NEAR(1e6 * green.fs_for_nearest(0.2), 768, 1e-9);
  // The sources round 720 mm^2 to "at least 700".
  EXPECT_NEAR(1e6 * green.fs_for(0.030, 6), 720, 1e-9);
  EXPECT_NEAR(RangeDesign{.fs = 700e-6}.resolution(6), 0.0309, 1e-4);
  EXPECT_NEAR(red.distance_of(red.resolution(4.2)), 4.2, 1e-12);
  // (3.4) prints 77 degrees.
  EXPECT_NEAR(green.laser_angle(0.006) * 180 / std::numbers::pi, 72.3, 0.05);
  EXPECT_NE(error_of([] { RangeDesign{}.check(); }).find("above 0 mm2"), std::string::npos);
}

/// dq for the spot's precision, from the model itself.
TEST(RangeDesign, ResolutionIsTheStepOfTheHyperbola) {
  const RangeDesign red{.fs = 1500e-6};
  const RangeModel model{.slope = red.slope(), .vanishing = 0};
  const double px = model.position(3);
  const double step = model.depth(px + 0.05).value_or(0) - model.depth(px - 0.05).value_or(0);
  EXPECT_NEAR(step / red.resolution(3), 1, 1e-5);
}

}  // namespace
}  // namespace facula
