// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/capture/capture_file.hpp>
#include <facula/acquire/capture/frame_source.hpp>
#include <facula/acquire/core/scan_file.hpp>
#include <facula/tests/acquire/simulate/small_head.hpp>
#include <facula/tests/support/matchers.hpp>
#include <facula/tests/support/temporary_folder.hpp>

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace facula {
namespace {

using Eigen::Vector3d;

// The small head on a pan axis: z up, looking along x.
Rig pan_head() {
  Rig rig = small_head();
  rig.axis.kind = AxisKind::kPan;
  Eigen::Matrix3d scan_from_camera;
  scan_from_camera << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  rig.axis.scan_from_camera = RigidTransform::from_rotation(scan_from_camera);
  rig.axis.scan_from_camera.translation = {0.05, 0.02, 0};
  return rig;
}

Scene small_room() {
  SceneObject room;
  room.name = "room";
  room.shape = RoomShape{{4, 4, 2.5}};
  return scene_with({room, box_at({1.5, 0.2, -0.1}, {0.3, 0.3, 0.3})});
}

SimulatedRun small_run() {
  SimulatedRun run;
  run.world_from_scan.translation = {0.1, -0.2, 0.05};
  run.world_from_scan.rotation = Eigen::AngleAxisd(0.4, Vector3d::UnitZ());
  for (int i = 0; i < 4; ++i) run.positions.push_back(-0.3 + 0.2 * i);
  return run;
}

TEST(SimulateCapture, IsReadBackAsTheCaptureItIs) {
  const TemporaryFolder folder;
  const Rig rig = pan_head();
  SimulateOptions options = options_for(rig);
  options.background_frames = true;
  const SimulatedRun run = small_run();
  std::size_t steps = 0;
  options.progress = [&](std::size_t done, std::size_t total) {
    ++steps;
    EXPECT_EQ(done, steps);
    EXPECT_EQ(total, 4U);
  };
  simulate_capture(folder / "run", small_room(), rig, run, options);
  EXPECT_EQ(steps, 4U);

  const Capture capture = read_capture(folder / "run");
  ASSERT_EQ(capture.frames.size(), 4U);
  EXPECT_EQ(capture.background.size(), 4U);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(capture.positions[i], run.positions[i], 1e-14);
  EXPECT_TRUE(is_near_pose(capture.world_from_scan, run.world_from_scan, 1e-12, 1e-12));
  EXPECT_EQ(capture.rig.camera.fx, rig.camera.fx);
  EXPECT_EQ(capture.stripe.channel, Channel::kGrey);
  EXPECT_GT(capture.stripe.sigma, 1.5);
  EXPECT_LT(capture.stripe.sigma, 3.0);

  const RigidTransform pose = run.world_from_scan * rig.axis.scan_from_camera_at(run.positions[2]);
  EXPECT_EQ(read_image(capture.frames[2]).pixels,
            simulate_frame(small_room(), rig, pose, true, 2, options).pixels);
  EXPECT_EQ(read_image(capture.background[2]).pixels,
            simulate_frame(small_room(), rig, pose, false, 2, options).pixels);

  const PolarScan truth = read_scan(folder / "run" / "truth.pcd");
  const PolarScan expected =
      true_scan(small_room(), rig, run.world_from_scan, run.positions, options);
  EXPECT_EQ(truth.valid, expected.valid);
  EXPECT_EQ(truth.range, expected.range);
}

TEST(SimulateCapture, SaysThatAPlumbPanHeadStandsUprightAndOfNoOther) {
  const TemporaryFolder folder;
  const auto stand_of = [&](const Rig& rig, const RigidTransform& pose) {
    simulate_capture(folder / "run", small_room(), rig, {pose, {0.1}}, options_for(rig));
    return read_capture(folder / "run").stand;
  };
  EXPECT_EQ(stand_of(pan_head(), small_run().world_from_scan), ScanStand::kUpright);
  RigidTransform tilted = small_run().world_from_scan;
  tilted.rotation = tilted.rotation * Eigen::AngleAxisd(0.01, Vector3d::UnitX());
  EXPECT_EQ(stand_of(pan_head(), tilted), ScanStand::kFree);
  Rig table = pan_head();
  table.axis.kind = AxisKind::kTurntable;
  EXPECT_EQ(stand_of(table, small_run().world_from_scan), ScanStand::kFree);
}

TEST(SimulateCapture, DoesNotDependOnTheNumberOfThreads) {
  const TemporaryFolder folder;
  const Rig rig = pan_head();
  SimulateOptions options = options_for(rig);
  options.num_threads = 1;
  simulate_capture(folder / "one", small_room(), rig, small_run(), options);
  options.num_threads = 2;
  simulate_capture(folder / "two", small_room(), rig, small_run(), options);
  const Capture one = read_capture(folder / "one");
  const Capture two = read_capture(folder / "two");
  for (std::size_t i = 0; i < one.frames.size(); ++i) {
    EXPECT_EQ(read_image(one.frames[i]).pixels, read_image(two.frames[i]).pixels) << i;
  }
}

TEST(SimulateCapture, ReplacesTheFramesOfALongerRun) {
  const TemporaryFolder folder;
  const Rig rig = pan_head();
  SimulatedRun run = small_run();
  simulate_capture(folder / "run", small_room(), rig, run, options_for(rig));
  run.positions.resize(2);
  simulate_capture(folder / "run", small_room(), rig, run, options_for(rig));
  EXPECT_EQ(read_capture(folder / "run").frames.size(), 2U);
}

TEST(SimulateCapture, AxisNoiseMovesTheHeadAndNotTheProgramme) {
  const TemporaryFolder folder;
  const Rig rig = pan_head();
  SimulateOptions options = options_for(rig);
  options.axis_errors.noise = 0.001;
  const SimulatedRun run = small_run();
  simulate_capture(folder / "run", small_room(), rig, run, options);
  const std::vector<double> programme = read_capture(folder / "run").positions;
  const std::vector<double> went = read_scan(folder / "run" / "truth.pcd").axis_position;
  double squares = 0;
  for (std::size_t i = 0; i < programme.size(); ++i) {
    EXPECT_NEAR(programme[i], run.positions[i], 1e-14);
    squares += std::pow(went[i] - run.positions[i], 2);
  }
  EXPECT_GT(squares, 0);
  EXPECT_LT(squares, 4 * 16e-6);
}

TEST(SimulateCapture, AsksForAPosition) {
  const TemporaryFolder folder;
  const Rig rig = pan_head();
  EXPECT_NE(error_of([&] {
              simulate_capture(folder / "run", small_room(), rig, SimulatedRun{}, options_for(rig));
            }).find("position"),
            std::string::npos);
}

}  // namespace
}  // namespace facula
