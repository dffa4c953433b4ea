// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/calibrate/camera_calibration.hpp>
#include <facula/acquire/calibrate/laser_calibration.hpp>
#include <facula/acquire/calibrate/render_board.hpp>
#include <facula/acquire/rig/rig_parameters.hpp>
#include <facula/tests/acquire/calibrate/board_scene.hpp>
#include <facula/tests/support/matchers.hpp>

#include <array>
#include <cmath>

#include <gtest/gtest.h>

namespace facula {
namespace {

const Board kBoard{.kind = BoardKind::kChessboard, .cols = 9, .rows = 6, .spacing = 0.015};

LaserPlane upright_sheet() {
  LaserPlane plane;
  plane.normal = Eigen::Vector3d(0.93, -0.06, 0.36).normalized();
  plane.distance = 0.13;
  return plane;
}

/// Where sheet and board meet, as pixels: the board is walked row by row, and in each the place on
/// the sheet found by bisection.
LaserLineView ideal_line(const RigidTransform& camera_from_board, const LaserPlane& plane) {
  LaserLineView line;
  for (int i = 0; i < 120; ++i) {
    const double y = 0.075 * i / 119;
    double left = -0.04;
    double right = 0.16;
    const auto off = [&](double x) {
      return plane.sheet_distance(camera_from_board * Eigen::Vector3d(x, y, 0));
    };
    if (off(left) * off(right) > 0) continue;
    for (int step = 0; step < 60; ++step) {
      const double middle = 0.5 * (left + right);
      (off(left) * off(middle) <= 0 ? right : left) = middle;
    }
    line.pixels.emplace_back(vga_camera().project(camera_from_board * Eigen::Vector3d(left, y, 0)));
    line.sigmas.push_back(0.1);
  }
  return line;
}

BoardPose pose_of(const CalibratedView& located) {
  return {located.camera_from_board,
          located.pose_covariance(std::array{0, 1, 5}, std::array{0, 1, 5})};
}

struct LineSet {
  std::vector<BoardPose> poses;
  std::vector<LaserLineView> lines;
};

/// Boards located from noisy points, lines with noise.
LineSet noisy_set(const LaserPlane& plane, int views, std::uint64_t seed) {
  LineSet set;
  Random random(seed);
  for (int i = 0; i < views; ++i) {
    const RigidTransform truth = board_place(kBoard, i);
    const BoardView seen = seen_board(kBoard, vga_camera(), truth, 0.1, random);
    set.poses.push_back(pose_of(locate_board(kBoard, seen, vga_camera())));
    set.lines.push_back(ideal_line(truth, plane));
    set.lines.back().view = static_cast<std::size_t>(i);
    for (Eigen::Vector2d& p : set.lines.back().pixels) p.x() += 0.1 * random.normal();
  }
  return set;
}

TEST(CalibrateLaser, FindsTheSheetExactlyWithoutNoise) {
  for (const double bow : {0.0, 0.02}) {
    LaserPlane truth = upright_sheet();
    truth.bow = bow;
    LineSet set;
    for (std::size_t i = 0; i < 6; ++i) {
      set.poses.push_back({board_place(kBoard, static_cast<int>(i)), {}});
      set.poses.back().plane_covariance.setZero();
      set.lines.push_back(ideal_line(set.poses.back().camera_from_board, truth));
      set.lines.back().view = i;
    }
    const LaserCalibration result =
        calibrate_laser(vga_camera(), set.poses, set.lines, 0, {.bow = bow != 0});
    EXPECT_LT((result.plane.normal - truth.normal).norm(), 1e-7);
    EXPECT_NEAR(result.plane.distance, truth.distance, 1e-8);
    EXPECT_NEAR(result.plane.bow, bow, 1e-6);
    EXPECT_LT(result.rms, 1e-8);
  }
}

/// Board poses from points with 0.1 px of noise and lines with 0.1 px: the bounds for the
/// plane, and the truth within 2 sigma in 90 % of the parameters at least.
TEST(CalibrateLaser, StatesAHonestCovariance) {
  const LaserPlane truth = upright_sheet();
  const TangentBasis basis = tangent_basis(truth.normal);
  int inside = 0;
  int all = 0;
  double worst_turn = 0;
  double worst_shift = 0;
  std::array<double, 3> chi{};
  constexpr int kTrials = 60;
  for (int trial = 0; trial < kTrials; ++trial) {
    const LineSet set = noisy_set(truth, 9, 1000 + static_cast<std::uint64_t>(trial));
    const LaserCalibration result = calibrate_laser(vga_camera(), set.poses, set.lines);
    const Eigen::Vector3d turn = result.plane.normal - truth.normal;
    const std::array<double, 3> errors = {
        turn.dot(basis.a), turn.dot(basis.b), 1000 * (result.plane.distance - truth.distance)};
    worst_turn = std::max(worst_turn, turn.norm());
    worst_shift = std::max(worst_shift, std::abs(errors[2]));
    for (std::size_t k = 0; k < 3; ++k) {
      const auto i = static_cast<Eigen::Index>(k);
      const double z = errors[k] / std::sqrt(result.covariance(i, i));
      inside += std::abs(z) < 2 ? 1 : 0;
      chi[k] += z * z / kTrials;
      ++all;
    }
  }
  EXPECT_GE(inside, 0.9 * all);
  // 60 trials: 1 +- 0.18 (1 sigma).
  for (const double c : chi) {
    EXPECT_GT(c, 0.5);
    EXPECT_LT(c, 1.6);
  }
  RecordProperty("worst_turn_udeg", static_cast<int>(worst_turn * 180e6 / M_PI));
  RecordProperty("worst_shift_nm", static_cast<int>(worst_shift * 1e6));
}

TEST(CalibrateLaser, LetsAWrongViewStandOutInTheHeldOutFigure) {
  LineSet set = noisy_set(upright_sheet(), 8, 5);
  for (Eigen::Vector2d& p : set.lines[3].pixels) p.x() += 8;
  const LaserCalibration result = calibrate_laser(vga_camera(), set.poses, set.lines);
  EXPECT_TRUE(one_says(result.warnings, "view 3 lies"));
  EXPECT_GT(result.views[3].held_out_rms, 1e-3);
  EXPECT_LT(result.views[4].rms, 5e-4);
  // The figure over all data holds the wrong view, although the fit resists it.
  EXPECT_GT(result.held_out_rms, 5e-4);
}

TEST(CalibrateLaser, RefusesSetsThatCannotDetermineASheet) {
  const LineSet set = noisy_set(upright_sheet(), 4, 5);
  EXPECT_TRUE(says(error_of([&] { calibrate_laser(vga_camera(), set.poses, {set.lines[0]}); }),
                   "in 2 pictures or more, found it in 1"));
  EXPECT_TRUE(says(error_of([&] { calibrate_laser(vga_camera(), set.poses, set.lines, 7); }),
                   "found it in 0"));
  EXPECT_TRUE(says(error_of([&] { calibrate_laser(vga_camera(), {set.poses[0]}, set.lines); }),
                   "belongs to view 1, but there are 1 poses"));
  LineSet same = set;
  same.poses[1] = same.poses[0];
  same.lines[1].pixels = same.lines[0].pixels;
  same.lines[1].sigmas = same.lines[0].sigmas;
  EXPECT_TRUE(says(error_of([&] {
                     calibrate_laser(vga_camera(), same.poses, {same.lines[0], same.lines[1]});
                   }),
                   "lie on one straight line in space"));
  LineSet torn = set;
  torn.lines[2].sigmas.pop_back();
  EXPECT_TRUE(says(error_of([&] { calibrate_laser(vga_camera(), torn.poses, torn.lines); }),
                   "expected one each"));
}

/// From rendered pictures alone: boards found, lines found on print and paper, sheet fitted.
TEST(FindLineOnBoard, GivesTheSheetFromRenderedPictures) {
  const LaserPlane truth = upright_sheet();
  std::vector<BoardPose> poses;
  std::vector<LaserLineView> lines;
  for (int i = 0; i < 5; ++i) {
    const RigidTransform place = board_place(kBoard, i);
    const Image8 dark = render_board(kBoard, vga_camera(), place, {}, {.seed = 2});
    const Image8 lit = render_board(kBoard,
                                    vga_camera(),
                                    place,
                                    {truth},
                                    {.laser_level = 60, .laser_width = 0.8e-3, .seed = 3});
    const BoardView view = find_board(dark.view(), kBoard, "dark");
    ASSERT_TRUE(view.found()) << view.failure;
    poses.push_back(pose_of(locate_board(kBoard, view, vga_camera())));
    lines.push_back(find_line_on_board(lit.view(),
                                       dark.view(),
                                       kBoard,
                                       vga_camera(),
                                       poses.back().camera_from_board,
                                       {.stripe = {.channel = Channel::kRed}}));
    ASSERT_EQ(lines.back().failure, "");
    lines.back().view = static_cast<std::size_t>(i);
  }
  const LaserCalibration result = calibrate_laser(vga_camera(), poses, lines);
  EXPECT_LT(std::acos(std::min(1.0, result.plane.normal.dot(truth.normal))), 0.1 * M_PI / 180);
  EXPECT_NEAR(result.plane.distance, truth.distance, 0.3e-3);
  EXPECT_LT(result.held_out_rms, 0.3e-3);
}

TEST(FindLineOnBoard, SaysThatThereIsNoLine) {
  const RigidTransform place = board_place(kBoard, 0);
  const Image8 dark = render_board(kBoard, vga_camera(), place, {});
  const LaserLineView line =
      find_line_on_board(dark.view(), {}, kBoard, vga_camera(), place, BoardLineOptions{});
  EXPECT_TRUE(line.pixels.empty());
  EXPECT_TRUE(says(line.failure, "no laser line on the board"));
  const Image8 other(10, 10, 3);
  EXPECT_TRUE(says(error_of([&] {
                     find_line_on_board(
                         other.view(), {}, kBoard, vga_camera(), place, BoardLineOptions{});
                   }),
                   "expected a picture of the camera's 640 x 480 px, got 10 x 10"));
}

}  // namespace
}  // namespace facula
