// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/rig/rig.hpp>
#include <facula/acquire/simulate/simulate.hpp>
#include <facula/acquire/triangulate/extract_scan.hpp>
#include <facula/apps/cli/session.hpp>
#include <facula/apps/commands/demo/demo_settings.hpp>

#include <filesystem>
#include <string>

namespace facula {

/// A simulated capture, what was read out of its frames, and the truth.
struct RecordedScan {
  std::string name;
  std::filesystem::path capture;        ///< folder
  RigidTransform true_world_from_scan;  ///< where it was really taken from
  ExtractResult extracted;              ///< its scan lies at the pose that is known so far
  PolarScan clean;                      ///< without mixed points
  std::size_t mixed_removed = 0;        ///< [1]
  PolarScan truth;                      ///< from the scene, not from the frames
};

/// What is simulated.
struct RecordingPlan {
  std::string name;
  const Scene* scene = nullptr;
  const Rig* rig = nullptr;
  RigidTransform world_from_scan;
  double step = 0;  ///< of a full turn of the axis [rad]
};

/// Simulates frames into captures/NAME, extracts scans/NAME.pcd from these files, and removes mixed
/// points.
RecordedScan record(const RecordingPlan& plan, const DemoSettings& settings, Session& session);

}  // namespace facula
