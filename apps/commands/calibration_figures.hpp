// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/calibrate/joint_calibration.hpp>
#include <facula/apps/cli/figures.hpp>

namespace facula {

/// The quality report of a joint calibration: the held-out residuals first, then per view, then the
/// parameters with their sigmas, then what to do.
void report_calibration(const JointCalibration& result, Figures& figures);

}  // namespace facula
