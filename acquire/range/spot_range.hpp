// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace facula {

/// A triangulating head by its parts, as source A writes it: the laser stands `baseline` beside the
/// camera and shines at `laser_angle` to the baseline; its spot is seen at column px. Lengths in
/// metres. Only the products f s / p / sin(beta) and the position of infinity can be seen from
/// outside, see RangeModel; here they are taken apart for the design of a head.
struct SpotRange {
  double focal_length = 0;                  ///< f [m]
  double baseline = 0;                      ///< s [m]
  double pixel_size = 0;                    ///< p [m]
  double offset = 0;                        ///< x = p px + offset (3) [m]
  double laser_angle = 1.5707963267948966;  ///< beta, between beam and baseline [rad]
  double middle_row = 0;                    ///< row of the camera's axis, y0 [px]

  /// (3), distance of the spot's picture from where it would be for a thing at infinity [m].
  double shift(double px) const;

  /// (1), distance square to the baseline [m]; negative or infinite beyond infinity's position.
  double perpendicular(double px) const;

  /// (2) and (4), along the beam [m].
  double along_beam(double px) const;

  /// (5), dq/dx = -q^2 / (f s): metres of q per metre of x.
  double sensitivity(double px) const;

  /// (6) and (7), for a line instead of a spot: distance from the baseline to the point seen in row
  /// `row`, within the plane of baseline and ray [m].
  double perpendicular_off_axis(double px, double row) const;

  /// Throws Error when a length is not above 0 or the angle not inside 0 to 180 degrees.
  void check() const;
};

}  // namespace facula
