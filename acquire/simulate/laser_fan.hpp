// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/rig/rig.hpp>
#include <facula/acquire/simulate/simulate.hpp>

#include <Eigen/Core>

namespace facula {

/// The light that leaves the laser: a fan from one point, thin and Gaussian across. Camera frame.
/// The derivation of each term stands in simulate_frame.cpp.
struct LaserFan {
  Eigen::Vector3d origin;       ///< where the fan starts, on the sheet [m]
  Eigen::Vector3d normal;       ///< of the sheet, unit [1]
  double distance = 0;          ///< of the sheet from the camera centre [m]
  double start_half_width = 0;  ///< 1 standard deviation at the origin [m]
  double divergence = 0;        ///< growth of the half width with distance [rad]
  double peak = 0;              ///< signal of white, square to the light, 1 m from the origin [DN]
  double falloff = 0;           ///< power of distance [1]

  /// Signed distance of a point from the sheet's middle [m].
  double sheet_distance(const Eigen::Vector3d& x) const { return normal.dot(x) - distance; }

  /// Standard deviation across the sheet at a distance from the origin [m].
  double half_width(double from_origin) const {
    return start_half_width + divergence * from_origin;
  }

  /// Signal of a white surface at `x` with unit `surface_normal`, lit or not by the fan's middle:
  /// everything but albedo, shadow and the Gaussian across the sheet [DN]. 0 when it looks away.
  double middle_signal(const Eigen::Vector3d& x, const Eigen::Vector3d& surface_normal) const;

  /// The same with the Gaussian across the sheet [DN].
  double signal(const Eigen::Vector3d& x, const Eigen::Vector3d& surface_normal) const;
};

/// The fan of the sheet that is lit. Checks rig and options; throws Error when the rig has no such
/// sheet.
LaserFan laser_fan(const Rig& rig, const SimulateOptions& options);

}  // namespace facula
