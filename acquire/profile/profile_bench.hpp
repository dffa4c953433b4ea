// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace facula {

/// The bench of source D by its parts: the laser shines square to the baseline; the camera stands
/// `baseline` beside the beam and its axis, `angle` to the baseline, meets the beam on the
/// reference plane.
struct ProfileBench {
  double baseline = 0;        ///< b [m]
  double lens_to_sensor = 0;  ///< B [m]
  double angle = 0;           ///< alpha [rad], inside 0 to 90 degrees

  /// h = b s sec^2(alpha) / (B + s tan(alpha)): height over the reference plane of a spot seen
  /// `shift` beside the sensor's middle [m]. The formula is re-derived, the print is damaged.
  double height(double shift) const;

  /// Its inverse [m].
  double shift(double height) const;

  void check() const;
};

}  // namespace facula
