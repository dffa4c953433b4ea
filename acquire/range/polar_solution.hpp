// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

namespace facula {

/// Source B's way from a stripe pixel to polar coordinates about the head's axis, (2.10) to (2.17).
/// Laser L, camera C, the pole O and the foot O' lie on the baseline; the sheet of light leaves L
/// at `laser_angle` from the perpendicular of the baseline, towards the camera.
struct PolarSolution {
  double focal_length_px = 0;  ///< f / p [px]
  double slope = 0;            ///< f s / p [px m]
  double vanishing = 0;        ///< where q is infinite: -C / p in (2.10) [px]
  double direction = 1;        ///< +1: q falls as px grows (as (2.10) is printed), -1: it grows [1]
  double middle_row = 240;     ///< [px]
  double laser_angle = 0;      ///< alpha in (2.13) [rad]
  double pole_to_laser = 0;    ///< O L along the baseline, above 0 [m]

  struct Polar {
    double range = 0;  ///< [m]
    double yaw = 0;    ///< from the perpendicular through O, towards the laser [rad]
    double pitch = 0;  ///< of the ray in the plane square to the baseline (2.11) [rad]
  };

  /// (2.17) repeats (2.15) in print and leaves the height out; here the range is the length of O O'
  /// combined with O'P. NaN beyond the vanishing position.
  Polar solve(double px, double row) const;

  /// The same point: x along the baseline towards the laser, y down the picture, z ahead [m].
  static Eigen::Vector3d cartesian(const Polar& polar);

  /// Throws Error when a length is not above 0 or the laser's angle not within 90 degrees.
  void check() const;
};

}  // namespace facula
