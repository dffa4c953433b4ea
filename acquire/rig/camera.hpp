// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include <Eigen/Core>

namespace facula {

/// Pinhole camera with Brown-Conrady distortion (Brown 1971; the five coefficients of OpenCV and of
/// Bouguet's toolbox). Camera frame: x right, y down, z forward. Pixel (0, 0) is the centre of the
/// top left pixel.
struct Camera {
  int width = 0;   ///< [px]
  int height = 0;  ///< [px]
  double fx = 0;   ///< focal length along x [px]
  double fy = 0;   ///< focal length along y [px]
  double cx = 0;   ///< principal point [px]
  double cy = 0;   ///< principal point [px]
  double k1 = 0;   ///< radial [1]
  double k2 = 0;   ///< radial [1]
  double p1 = 0;   ///< tangential [1]
  double p2 = 0;   ///< tangential [1]
  double k3 = 0;   ///< radial [1]

  /// Distorts a point of the plane z = 1.
  Eigen::Vector2d distort(const Eigen::Vector2d& normalized) const;

  /// Derivative of distort() there.
  Eigen::Matrix2d distortion_jacobian(const Eigen::Vector2d& normalized) const;

  /// Pixel of a point in the camera frame; z must be above 0.
  Eigen::Vector2d project(const Eigen::Vector3d& x_in_camera) const;

  /// Point of the plane z = 1 that projects to `pixel` (Newton's method on distort()); none where
  /// the distortion cannot be inverted.
  std::optional<Eigen::Vector2d> undistort(const Eigen::Vector2d& pixel) const;

  /// Throws Error when a value is NaN or absurd, or the distortion folds the image over itself.
  void check() const;
};

}  // namespace facula
