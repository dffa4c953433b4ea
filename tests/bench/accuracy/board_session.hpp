// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/calibrate/joint_calibration.hpp>
#include <facula/acquire/core/random.hpp>
#include <facula/acquire/rig/rig.hpp>

namespace facula {

/// Pictures of a ChArUco board with the laser line on it, held by hand in front of a head: what a
/// user does for the joint calibration, as noisy positions.
struct BoardSession {
  Board board;
  double nearest = 0.3;       ///< of the boards [m]
  double farthest = 4;        ///< [m]
  int views = 40;             ///< half of them nearer than the geometric mean of the two
  double noise = 0.1;         ///< of board points and line [px]
  double largest_tilt = 0.6;  ///< of the board [rad]
};

/// The head's own lasers are all lit; a view shows what of the board lies in the picture.
CalibrationSet record_session(const Rig& truth, const BoardSession& session, Random& random);

}  // namespace facula
