// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/apps/cli/command.hpp>

namespace facula {

/// Camera, sheets and axis from one set of views of boards.
Command calibrate_joint_command();

/// The axis alone, the camera taken as exact.
Command calibrate_axis_command();

/// A calibration set by simulation.
Command calibrate_example_command();

}  // namespace facula
