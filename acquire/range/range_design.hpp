// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace facula {

/// The design of a triangulating head: what focal length times baseline buys (source A; source B
/// (3.1) to (3.4)).
struct RangeDesign {
  double fs = 0;                ///< focal length times baseline [m^2]
  double pixel_size = 6e-6;     ///< p [m]
  int width = 640;              ///< of the picture, across the line [px]
  double spot_precision = 0.1;  ///< to which the line is located [px]

  /// (3.1): where the stripe leaves the picture, infinity lying on the other edge [m].
  double nearest() const;

  /// (3.3): what one step of the spot's precision is worth at a distance [m].
  double resolution(double distance) const;

  /// The distance at which resolution() is this [m].
  double distance_of(double resolution) const;

  /// The f s that makes resolution(distance) this much [m^2].
  double fs_for(double resolution, double distance) const;

  /// The largest f s whose nearest() is no farther than this [m^2].
  double fs_for_nearest(double distance) const;

  /// A of the range model, f s / p [px m].
  double slope() const { return fs / pixel_size; }

  /// (3.4): angle between the sheet and the baseline that puts infinity on the picture's edge
  /// [rad].
  double laser_angle(double focal_length) const;

  /// Throws Error on values that cannot be.
  void check() const;
};

}  // namespace facula
