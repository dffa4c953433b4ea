// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/capture/frame_source.hpp>
#include <facula/acquire/core/scan_file.hpp>
#include <facula/acquire/simulate/axis_errors.hpp>
#include <facula/tests/acquire/simulate/small_head.hpp>
#include <facula/tests/support/temporary_folder.hpp>

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace facula {
namespace {

TEST(AxisErrors, AreNoneByDefault) {
  const std::vector<double> programme = {0.1, 0.5, 0.3, -0.2};
  EXPECT_EQ(travelled_positions(programme, {}, 1), programme);
}

TEST(AxisErrors, BacklashLagsAfterTheReversalOnly) {
  const std::vector<double> up_and_down = {0, 1, 2, 3, 2.9, 2.6, 2, 1, 1.2, 1.6, 2};
  const std::vector<double> expected = {0, 1, 2, 3, 3, 3, 2.5, 1.5, 1.5, 1.6, 2};
  const std::vector<double> path = travelled_positions(up_and_down, {.backlash = 0.5}, 1);
  for (std::size_t i = 0; i < path.size(); ++i) EXPECT_NEAR(path[i], expected[i], 1e-12) << i;
  // The other way round it is the mirror image.
  std::vector<double> down_and_up = up_and_down;
  for (double& position : down_and_up) position = -position;
  const std::vector<double> other = travelled_positions(down_and_up, {.backlash = 0.5}, 1);
  for (std::size_t i = 0; i < path.size(); ++i) EXPECT_NEAR(other[i], -expected[i], 1e-12) << i;
}

TEST(AxisErrors, PeriodicErrorHasAmplitudePeriodAndPhase) {
  AxisErrors errors;
  errors.periodic_amplitude = 0.02;
  errors.period = 0.5;
  errors.phase = 0.3;
  const std::vector<double> path = travelled_positions({0, 0.1, 0.6, 1.1}, errors, 1);
  EXPECT_NEAR(path[0], 0.02 * std::sin(0.3), 1e-12);
  EXPECT_NEAR(path[1] - 0.1, 0.02 * std::sin(0.4 * std::numbers::pi + 0.3), 1e-12);
  EXPECT_NEAR(path[2] - 0.6, path[1] - 0.1, 1e-12);
  EXPECT_NEAR(path[3] - 1.1, path[1] - 0.1, 1e-12);
}

TEST(AxisErrors, LatencyShowsTheAxisFartherOn) {
  const std::vector<double> path =
      travelled_positions({0, 0.1}, {.speed = 0.2, .latency = 0.05}, 1);
  EXPECT_NEAR(path[0], 0.01, 1e-12);
  EXPECT_NEAR(path[1], 0.11, 1e-12);
}

TEST(AxisErrors, NoiseHasItsStandardDeviation) {
  const std::vector<double> programme(20000, 1.0);
  double square = 0;
  for (const double position : travelled_positions(programme, {.noise = 0.003}, 5)) {
    square += std::pow(position - 1, 2) / 20000;
  }
  EXPECT_NEAR(std::sqrt(square), 0.003, 4 * 0.003 / std::sqrt(40000.0));
}

// While the head moves, the dark frames before and after show it where it was then.
TEST(SimulateCapture, TakesDarkFramesOnTheWay) {
  const TemporaryFolder folder;
  Rig rig = small_head();
  rig.axis.kind = AxisKind::kLinear;
  rig.axis.direction = Eigen::Vector3d::UnitX();
  SimulateOptions options = quiet_options(rig);
  options.ambient = 100;
  options.background_frames = options.second_background = true;
  options.timing.frame_interval = 0.1;
  options.axis_errors.speed = 0.3;
  options.axis_errors.latency = 0.2;
  // A bar 0.1 m wide before a black wall.
  SceneObject wall = wall_at(2);
  wall.albedo = 0;
  const Scene scene = scene_with({wall, box_at({0.1, 0, 1}, {0.1, 4, 0.02})});
  simulate_capture(folder / "run", scene, rig, {{}, {0.0}}, options);
  const double far_side[] = {0.03, 0.06, 0.09};  // of the camera: dark, lit, dark
  const char* names[] = {"background", "frames", "background_after"};
  for (int i = 0; i < 3; ++i) {
    const Image8 frame = read_image(folder / "run" / names[i] / "0000.png");
    const double edge = 119.5 + 600 * (0.05 - far_side[i]) / 0.99;  // left edge of the bar
    const int c = static_cast<int>(std::floor(edge));
    EXPECT_LT(frame.row(10)[c - 2], 10) << names[i];
    EXPECT_NEAR(frame.row(10)[c + 2], 80, 1) << names[i];
  }
  const PolarScan truth = read_scan(folder / "run" / "truth.pcd");
  EXPECT_NEAR(truth.sensor_origin[0].x(), 0.06, 1e-6);
}

}  // namespace
}  // namespace facula
