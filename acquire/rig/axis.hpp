// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/rigid_transform.hpp>

#include <string>

#include <Eigen/Core>

namespace facula {

enum class AxisKind {
  kNone,       ///< nothing moves
  kPan,        ///< the head turns about the scan frame's z axis; positions in rad
  kTurntable,  ///< the object turns about the scan frame's z axis; positions in rad
  kLinear      ///< the head moves along `direction`; positions in m
};

/// What moves between two frames. A frame carries one number, its position on the axis.
struct Axis {
  AxisKind kind = AxisKind::kNone;

  /// At position 0. The scan frame's z axis is the axis of rotation.
  RigidTransform scan_from_camera;

  /// Of a linear axis: unit vector in the scan frame along which the head moves when the position
  /// grows (for an object that moves, its opposite) [1].
  Eigen::Vector3d direction = Eigen::Vector3d::UnitX();

  /// Where the camera is in the scan frame at a position [rad or m]:
  ///   pan        Rz(position) * scan_from_camera
  ///   turntable  Rz(-position) * scan_from_camera   (the scan frame turns with the object)
  ///   linear     scan_from_camera shifted by position * direction
  RigidTransform scan_from_camera_at(double position) const;

  bool is_revolute() const { return kind == AxisKind::kPan || kind == AxisKind::kTurntable; }

  void check() const;
};

/// "none", "pan", "turntable" or "linear".
std::string to_string(AxisKind kind);

}  // namespace facula
