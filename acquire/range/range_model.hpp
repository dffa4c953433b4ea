// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include <Eigen/Core>

namespace facula {

/// The ranging hyperbola of a triangulating head (sources A (4) and B (2.10)), as one measures it:
///   depth = slope / (vanishing - px - bend (px - centre)^3)
/// px is the stripe's position across the line, in the picture as the camera saw it. Depth is
/// square to the camera's picture, so that the point is depth * (x, y, 1) on the row's own ray:
/// that holds source A's (6), (7) for rows off the axis. A negative slope is a head whose stripe
/// wanders towards smaller px as things come nearer to the camera's other side; both signs are
/// alike.
struct RangeModel {
  double slope = 0;      ///< A = f s / p, signed [px m]
  double vanishing = 0;  ///< x0, where the stripe of a thing at infinity lies [px]
  double bend = 0;       ///< third-order distortion term, 0 = none [1/px^2]
  double centre = 0;     ///< about which the bend counts [px]

  double lowest_px = 0;   ///< positions between which it was fitted; equal = not known [px]
  double highest_px = 0;  ///< [px]

  /// Covariance of slope, vanishing and bend [px m, px, 1/px^2]; zero where nobody estimated it.
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();

  /// None on the far side of the vanishing position and on it [m].
  std::optional<double> depth(double px) const;

  /// Where the stripe of a thing at `depth` [m] lies; depth above 0, infinity is allowed [px].
  double position(double depth) const;

  /// d depth / d px at a position that has a depth (source A (5)) [m/px].
  double depth_per_px(double px) const;

  /// 1 standard deviation of depth(px) from the covariance alone [m].
  double calibration_sigma(double px) const;

  /// Throws Error when a value is NaN, the slope is 0, or the hyperbola turns back on itself within
  /// the fitted positions.
  void check() const;
};

}  // namespace facula
