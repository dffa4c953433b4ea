// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/rig/rig.hpp>

#include <cstddef>
#include <vector>

#include <Eigen/Core>

namespace facula {

/// What the uncertainty of the calibration adds to a triangulated point: the covariance of the
/// rig's parameters carried through undistortion, intersection and axis, to first order, onto the
/// camera's ray as the scan frame sees it. Unlike the stripe's own noise it is common to
/// neighbouring points. It is computed on a grid of pixels, as variance of the inverse range, which
/// hardly varies over the image, and interpolated; where the grid has no intersection, directly.
class CalibrationSigma {
 public:
  /// Throws Error when the rig has sheets, but not this one.
  CalibrationSigma(const Rig& rig, std::size_t laser);

  /// Whether the rig says how well it is known; the variance is 0 where not.
  bool known() const { return !changed_.empty(); }

  /// Variance along the ray of `pixel`, whose point lies `range` from the camera [m], at an axis
  /// position [rad or m]. [m^2]
  double variance(const Eigen::Vector2d& pixel, double range, double position) const;

  /// The same without the grid; NaN where the ray misses the sheet.
  double exact_variance(const Eigen::Vector2d& pixel, double position) const;

 private:
  /// Variance of the inverse range [1/m^2] as a polynomial of the axis position: constant but for
  /// linear axes, whose direction moves points in proportion to the position.
  using Node = Eigen::Vector3d;

  Node node_at(const Eigen::Vector2d& pixel) const;

  Rig rig_;
  std::size_t laser_ = 0;
  std::vector<Rig> changed_;  ///< per parameter, one step up and one down
  std::vector<double> step_;  ///< per parameter, in the unit of its name
  Eigen::MatrixXd covariance_;
  std::vector<Node> nodes_;
  Eigen::Vector2d spacing_ = Eigen::Vector2d::Ones();  ///< [px]
};

}  // namespace facula
