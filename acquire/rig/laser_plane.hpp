// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>

#include <Eigen/Core>

namespace facula {

/// The sheet of light: points x in the camera frame with normal . x = distance.
struct LaserPlane {
  std::string name = "laser";
  Eigen::Vector3d normal = Eigen::Vector3d::UnitX();  ///< unit length, camera frame [1]
  double distance = 0;                                ///< from the camera centre [m]

  /// Where the ray from the camera centre along `direction` meets the sheet; none when it does not
  /// in front of the camera or grazes it.
  std::optional<Eigen::Vector3d> intersect(const Eigen::Vector3d& direction) const;

  /// Throws Error when the normal is not of unit length or the plane passes through the camera
  /// centre (every point of the line would then lie on one ray).
  void check() const;
};

}  // namespace facula
