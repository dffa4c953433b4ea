// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/capture/capture_file.hpp>
#include <facula/acquire/log/stripe_log_reader.hpp>
#include <facula/acquire/triangulate/extract_log.hpp>
#include <facula/tests/acquire/simulate/small_head.hpp>
#include <facula/tests/support/temporary_folder.hpp>

#include <bit>
#include <cstdint>
#include <cstring>

#include <gtest/gtest.h>

namespace facula {

/// A head that pans past a slanted wall with a box before it; the lens distorts, the sheet bows.
inline Rig panning_head() {
  Rig rig = small_head();
  rig.camera.k1 = -0.2;
  rig.camera.p1 = 0.001;
  rig.lasers[0].bow = 0.01;
  rig.axis.kind = AxisKind::kPan;
  // The axis of the pan is the camera's y axis: z of the scan frame points up, y of the camera
  // down.
  Eigen::Matrix3d turn;
  turn << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  rig.axis.scan_from_camera.rotation = Eigen::Quaterniond(turn);
  return rig;
}

inline SimulatedRun pan_run(int frames) {
  SimulatedRun run;
  for (int i = 0; i < frames; ++i) run.positions.push_back(0.3 + 0.002 * i);
  return run;
}

/// A room about the head, in the frame whose z is up.
inline Scene room_scene() {
  SceneObject room;
  room.name = "room";
  room.shape = RoomShape{Eigen::Vector3d(5, 5, 3)};
  room.albedo = 0.7;
  SceneObject box = box_at({1.6, 0.3, 0}, {0.4, 0.6, 0.15});
  return scene_with({room, box});
}

/// Writes such a capture into `folder` and reads it.
inline Capture logged_wall(const std::filesystem::path& folder,
                           int frames,
                           bool background = false) {
  const Rig rig = panning_head();
  SimulateOptions options = options_for(rig);
  options.background_frames = background;
  simulate_capture(folder, room_scene(), rig, pan_run(frames), options);
  return read_capture(folder);
}

template <typename Value>
bool same_bytes(const std::vector<Value>& a, const std::vector<Value>& b) {
  return a.size() == b.size() &&
         (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(Value)) == 0);
}

/// Every number of two scans alike to the last bit, NaN included.
inline testing::AssertionResult is_same_scan(const PolarScan& a, const PolarScan& b) {
  if (a.rows != b.rows || a.cols != b.cols) {
    return testing::AssertionFailure()
           << a.rows << " x " << a.cols << " against " << b.rows << " x " << b.cols;
  }
  if (!same_bytes(a.valid, b.valid)) {
    std::size_t cells = 0;
    for (std::size_t i = 0; i < a.valid.size(); ++i) cells += a.valid[i] != b.valid[i] ? 1U : 0U;
    return testing::AssertionFailure() << cells << " cells are valid in one of them only";
  }
  std::size_t cells = 0;
  for (std::size_t i = 0; i < a.point.size(); ++i) {
    bool same = true;
    for (Eigen::Index k = 0; k < 3; ++k) {
      same = same && std::bit_cast<std::uint32_t>(a.point[i][k]) ==
                         std::bit_cast<std::uint32_t>(b.point[i][k]);
    }
    cells += same ? 0U : 1U;
  }
  if (cells > 0) return testing::AssertionFailure() << cells << " points differ";
  const bool rest = same_bytes(a.range, b.range) && same_bytes(a.yaw, b.yaw) &&
                    same_bytes(a.pitch, b.pitch) && same_bytes(a.intensity, b.intensity) &&
                    same_bytes(a.sigma, b.sigma) && same_bytes(a.axis_position, b.axis_position) &&
                    same_bytes(a.time, b.time) && same_bytes(a.sensor_origin, b.sensor_origin) &&
                    a.stand == b.stand &&
                    a.world_from_scan.translation == b.world_from_scan.translation &&
                    a.world_from_scan.rotation.coeffs() == b.world_from_scan.rotation.coeffs();
  return rest ? testing::AssertionSuccess()
              : testing::AssertionFailure() << "the points are alike, other arrays differ";
}

}  // namespace facula
