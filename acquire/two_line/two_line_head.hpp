// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include <Eigen/Core>

namespace facula {

/// Source E's rangefinder: two level lines of light a known distance apart, one camera between
/// them, z = f dY / dy (4). Positions are taken on the plane z = 1, so that f has been divided out
/// by the camera model.
struct TwoLineHead {
  double spacing = 0;  ///< dY, between the two sheets where they leave the head [m]

  /// By how much the sheets drift apart (+) or together (-) per metre of distance: what dy / f
  /// tends to far away. 0 for parallel sheets, as the source has it [1].
  double divergence = 0;

  /// Refractive index of the medium in front of a flat window, for a camera that was calibrated in
  /// air: 1.33 in water. 1 for air, and for a camera calibrated in the medium it looks into, which
  /// is what the source does.
  double medium_index = 1;

  /// Depth of a surface where the two lines are seen `separation` apart on the plane z = 1 [m];
  /// none when the lines are no farther apart than at infinity.
  std::optional<double> depth(double separation) const;

  /// Separation of the two lines on a surface at `depth` [m] above 0.
  double separation(double depth) const { return spacing / depth + divergence; }

  /// (11): z^2 |d(dy)| / (f dY), for the separation's error on the plane z = 1 [m].
  double depth_error(double depth, double separation_error) const;

  /// A ray of the camera in air as it goes on in the medium (Snell's law at a flat window square to
  /// the camera's axis; the window's distance from the camera is left out) on the plane z = 1.
  Eigen::Vector2d in_medium(const Eigen::Vector2d& normalized) const;

  /// Throws Error on values that are not finite, a spacing of 0 or less, an index outside 1 to 3.
  void check() const;
};

}  // namespace facula
