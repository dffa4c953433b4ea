// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/calibrate/joint_model.hpp>

#include <string>
#include <vector>

namespace facula {

/// Where the joint calibration starts: each part by its own closed or simple way.
struct JointStart {
  JointState state;
  std::vector<JointSight> sights;
  std::vector<std::string> rejected;  ///< views left out, and why
  std::vector<std::string> warnings;
};

/// Camera from its boards (unless given), board poses from the camera, axis from the poses, sheets
/// from the lines on the boards. Throws Error when the set contradicts itself or holds too little.
JointStart start_jointly(const CalibrationSet& set, const JointOptions& options);

}  // namespace facula
