// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/calibrate/joint_calibration.hpp>

#include <filesystem>
#include <optional>

namespace facula {

/// What a calibration.toml holds.
struct CalibrationSetFile {
  CalibrationSet set;
  double position_sigma = 0;     ///< of the axis positions [rad or m]
  std::optional<Camera> camera;  ///< of the rig it names, to start from
};

/// Reads calibration.toml, described in docs/calibration.md: boards, groups of views with their
/// corners from files (.csv) or pictures, laser lines from files or pictures, axis positions. Lines
/// in pictures are looked for with the camera that the file names, else with one calibrated from
/// the corners. Throws Error naming file and key, line or picture.
CalibrationSetFile read_calibration_set(const std::filesystem::path& path);

/// Writes a set as calibration.toml with its corners, lines and positions as .csv into a folder
/// that is there.
void write_calibration_set(const std::filesystem::path& folder, const CalibrationSet& set);

}  // namespace facula
