// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/calibrate/camera_calibration.hpp>

#include <vector>

namespace facula {

/// The largest angle between the normals of any two boards [rad].
double largest_turn_between_normals(const std::vector<RigidTransform>& camera_from_board);

/// Adds what the views (those used) leave weak: too few, too little tilt, parts of the image
/// without points, parameters of little certainty, blur, a held-out error far above the fit's.
void add_camera_warnings(const Board& board,
                         const std::vector<BoardView>& views,
                         CameraCalibration& result);

}  // namespace facula
