// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/calibrate/camera_bundle.hpp>
#include <facula/acquire/calibrate/camera_calibration.hpp>
#include <facula/tests/acquire/calibrate/board_scene.hpp>
#include <facula/tests/support/matchers.hpp>

#include <array>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace facula {
namespace {

const Board kBoard{.kind = BoardKind::kChessboard, .cols = 9, .rows = 6, .spacing = 0.016};

std::vector<BoardView> seen_views(int count, double noise, std::uint64_t seed) {
  std::vector<BoardView> views;
  Random random(seed);
  for (int i = 0; i < count; ++i) {
    views.push_back(seen_board(kBoard, vga_camera(), board_place(kBoard, i), noise, random));
    views.back().name = "view " + std::to_string(i);
  }
  return views;
}

std::array<double, 9> numbers(const Camera& c) {
  return {c.fx, c.fy, c.cx, c.cy, c.k1, c.k2, c.p1, c.p2, c.k3};
}

TEST(CalibrateCamera, FindsTheCameraExactlyWithoutNoise) {
  const CameraCalibration result = calibrate_camera(kBoard, seen_views(10, 0, 1));
  const auto found = numbers(result.camera);
  const auto truth = numbers(vga_camera());
  for (std::size_t i = 0; i < 9; ++i) EXPECT_NEAR(found[i], truth[i], 1e-5) << i;
  EXPECT_LT(result.rms, 1e-7);
  for (const CalibratedView& view : result.views) {
    EXPECT_TRUE(is_near_pose(
        view.camera_from_board, board_place(kBoard, static_cast<int>(view.view)), 1e-7, 1e-8));
  }
}

/// 0.1 px of noise: 9 parameters in 40 trials must lie within 2 sigma in 95 % of cases; the issue
/// asks for 90 %. Binomial: 360 draws of 95.4 % have a standard deviation of 1.1 %.
TEST(CalibrateCamera, StatesAHonestCovariance) {
  int inside = 0;
  int all = 0;
  double held_out = 0;
  double rms = 0;
  const auto truth = numbers(vga_camera());
  std::array<double, 9> chi{};
  constexpr int kTrials = 40;
  for (int trial = 0; trial < kTrials; ++trial) {
    const CameraCalibration result =
        calibrate_camera(kBoard, seen_views(8, 0.1, 100 + static_cast<std::uint64_t>(trial)));
    const auto found = numbers(result.camera);
    for (std::size_t i = 0; i < 9; ++i) {
      const auto k = static_cast<Eigen::Index>(i);
      const double z = (found[i] - truth[i]) / std::sqrt(result.covariance(k, k));
      inside += std::abs(z) < 2 ? 1 : 0;
      chi[i] += z * z / kTrials;
      ++all;
    }
    held_out += result.held_out_rms / kTrials;
    rms += result.rms / kTrials;
  }
  EXPECT_GE(inside, 0.90 * all);
  // chi squared per parameter over 40 trials: 1 +- 0.22 (1 sigma).
  for (const double c : chi) {
    EXPECT_GT(c, 0.4);
    EXPECT_LT(c, 1.9);
  }
  // Point distances of two coordinates of 0.1 px noise.
  EXPECT_NEAR(rms, 0.1 * std::sqrt(2.0), 0.01);
  EXPECT_GT(held_out, rms);
  EXPECT_LT(held_out, 1.15 * rms);
}

/// The pole of the line at infinity against the middle of many points of the projected circle's
/// rim, taken as the centre of the ellipse through them (by its extreme points).
TEST(CameraBundle, KnowsWhereTheMiddleOfATiltedCircleLies) {
  Camera pinhole{.width = 2000, .height = 2000, .fx = 1000, .fy = 1000, .cx = 1000, .cy = 1000};
  RigidTransform pose;
  pose.rotation =
      Eigen::Quaterniond(Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 0.4, 0).normalized()));
  pose.translation = Eigen::Vector3d(0.05, -0.03, 0.4);
  const Eigen::Vector3d centre(0.02, 0.01, 0);
  const double diameter = 0.03;
  Eigen::Vector2d low = Eigen::Vector2d::Constant(1e9);
  Eigen::Vector2d high = -low;
  for (int i = 0; i < 400000; ++i) {
    const double t = i * 2 * M_PI / 400000;
    const Eigen::Vector3d rim =
        centre + diameter / 2 * Eigen::Vector3d(std::cos(t), std::sin(t), 0);
    const Eigen::Vector2d p = pinhole.project(pose * rim);
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  // An ellipse is symmetric about its centre, so its bounding box is too.
  const CameraBundle bundle{pinhole, {pose}};
  EXPECT_LT((seen_at(bundle, 0, centre, diameter) - 0.5 * (low + high)).norm(), 1e-5);
  EXPECT_GT((pinhole.project(pose * centre) - 0.5 * (low + high)).norm(), 0.5);
}

TEST(CalibrateCamera, NamesAViewThatDoesNotFit) {
  auto views = seen_views(9, 0.1, 4);
  for (std::size_t i = 0; i < views[3].pixels.size(); ++i) {
    views[3].pixels[i] += Eigen::Vector2d(2 * std::sin(static_cast<double>(i)), 3);
  }
  views[5].ids.clear();
  views[5].failure = "blurred: edges 9 px wide";
  const CameraCalibration result = calibrate_camera(kBoard, views);
  EXPECT_TRUE(one_says(result.rejected, "'view 3': fits to"));
  EXPECT_TRUE(one_says(result.rejected, "'view 5': blurred: edges 9 px"));
  EXPECT_EQ(result.views.size(), 7U);
  EXPECT_NEAR(result.camera.fx, 700, 3);
}

TEST(CalibrateCamera, RefusesSetsThatCannotDetermineACamera) {
  EXPECT_TRUE(says(error_of([] { calibrate_camera(kBoard, seen_views(2, 0.1, 1)); }),
                   "expected the board in 3 pictures or more, found it in 2 of 2"));
  EXPECT_TRUE(says(error_of([] { calibrate_camera(kBoard, {}); }), "found it in 0 of 0"));

  auto sizes = seen_views(5, 0.1, 1);
  std::swap(sizes[3].image_width, sizes[3].image_height);
  EXPECT_TRUE(says(error_of([&] { calibrate_camera(kBoard, sizes); }),
                   "pictures of one size, got 640 x 480 ('view 0') and 480 x 640 ('view 3')"));

  std::vector<BoardView> parallel;
  Random random(8);
  for (int i = 0; i < 6; ++i) {
    RigidTransform pose = board_place(kBoard, 0);
    pose.translation += Eigen::Vector3d(0.01 * i, -0.005 * i, 0.03 * i);
    parallel.push_back(seen_board(kBoard, vga_camera(), pose, 0.05, random));
  }
  EXPECT_TRUE(says(error_of([&] { calibrate_camera(kBoard, parallel); }),
                   "all 6 boards are parallel to each other"));

  auto broken = seen_views(5, 0.1, 1);
  broken[2].pixels[7].x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(says(error_of([&] { calibrate_camera(kBoard, broken); }), "no finite pixel"));
  broken = seen_views(5, 0.1, 1);
  broken[2].ids[3] = 4711;
  EXPECT_TRUE(says(error_of([&] { calibrate_camera(kBoard, broken); }), "4711"));
  EXPECT_TRUE(
      says(error_of([] { calibrate_camera(kBoard, seen_views(5, 0.1, 1), {.radial_terms = 4}); }),
           "radial_terms"));
}

TEST(CalibrateCamera, WarnsOfWhatTheViewsLeaveOpen) {
  std::vector<BoardView> weak;
  Random random(8);
  for (int i = 0; i < 5; ++i) {
    RigidTransform pose;
    pose.rotation = Eigen::Quaterniond(
        Eigen::AngleAxisd(0.06, Eigen::Vector3d(std::cos(2.0 * i), std::sin(2.0 * i), 0)));
    pose.translation = Eigen::Vector3d(-0.16, -0.1, 0.6 + 0.01 * i);
    weak.push_back(seen_board(kBoard, vga_camera(), pose, 0.1, random));
  }
  const CameraCalibration result = calibrate_camera(kBoard, weak);
  EXPECT_TRUE(one_says(result.warnings, "only 5 views"));
  EXPECT_TRUE(one_says(result.warnings, "too little tilt"));
  EXPECT_TRUE(one_says(result.warnings, "no points in"));
  EXPECT_TRUE(one_says(result.warnings, "the focal length is known to"));
  // The truth lies within what the weak set claims to know.
  EXPECT_LT(std::abs(result.camera.fx - 700), 4 * std::sqrt(result.covariance(0, 0)));
}

TEST(LocateBoard, FindsThePoseAmongWrongPoints) {
  Random random(2);
  BoardView view = seen_board(kBoard, vga_camera(), board_place(kBoard, 4), 0.1, random);
  for (const std::size_t i : {3U, 17U, 30U, 44U}) view.pixels[i] += Eigen::Vector2d(25, -40);
  const CalibratedView located = locate_board(kBoard, view, vga_camera());
  EXPECT_EQ(located.points, 50U);
  EXPECT_TRUE(is_near_pose(located.camera_from_board, board_place(kBoard, 4), 2e-3, 1e-3));
  view.pixels.assign(view.pixels.size(), Eigen::Vector2d(100, 100));
  EXPECT_TRUE(says(error_of([&] { locate_board(kBoard, view, vga_camera()); }), "agree"));
}

}  // namespace
}  // namespace facula
