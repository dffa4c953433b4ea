// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/rigid_transform.hpp>
#include <facula/acquire/rig/axis.hpp>

#include <cstddef>
#include <string>
#include <vector>

namespace facula {

/// One sight of a board at one position of the axis. Pan: the head turns and the board stands.
/// Turntable: the board lies on the table. Linear: the head moves along the board.
struct AxisView {
  std::string name;
  std::size_t placement = 0;  ///< equal for views between which the board was not touched [1]
  double position = 0;        ///< [rad, of a linear axis m]
  RigidTransform camera_from_board;  ///< [m]
};

/// How one sight fits: where the axis and the other sights say the board is.
struct AxisResidual {
  double distance = 0;  ///< of the board's origin [m]
  double turn = 0;      ///< of the board [rad]
  bool inlier = true;
};

struct AxisFit {
  Axis axis;
  std::vector<RigidTransform>
      scan_from_board;              ///< per placement; of those without view the identity
  std::vector<AxisResidual> views;  ///< as given
  double rms_distance = 0;          ///< over all views, wrong ones included [m]
  double rms_turn = 0;              ///< over all views, wrong ones included [rad]
  double gain = 1;                  ///< what the boards moved per what the positions say [1]
  double span = 0;  ///< largest difference of positions within a placement [rad or m]
  std::vector<std::string> warnings;
};

/// The axis from poses of boards, in closed form: every pair of views of a placement votes for a
/// direction and a centre, the geometric median of the votes is immune to wrong poses (up to about
/// a quarter of the views), and least squares over the pairs that agree gives the result.
/// The scan frame is chosen thus: z along the axis, so that positions grow as the axis turns
/// (turntable: the object turns right-handed about z; pan: the head does). Turntable: x towards the
/// camera, z = 0 on the first board that lies within 20 degrees of square to the axis. Pan: x where
/// the camera looks at position 0. Otherwise the origin is the axis' point nearest to the camera.
/// Linear: the camera frame at position 0.
/// Throws Error, saying which, when the views cannot determine an axis: fewer than 3, all at one
/// position, within 3 degrees (3 mm), or in contradiction to the positions.
AxisFit fit_axis(AxisKind kind, const std::vector<AxisView>& views);

}  // namespace facula
