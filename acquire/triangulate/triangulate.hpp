// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/rig/rig.hpp>

#include <optional>

#include <Eigen/Core>

namespace facula {

/// A point on the stripe with its uncertainty.
struct TriangulatedPoint {
  Eigen::Vector3d x_in_camera;  ///< [m]
  double sigma = 0;             ///< 1 standard deviation along the ray [m]
};

/// Undistort, then ray meets sheet. `pixel_sigma` [px] is the stripe's standard deviation across
/// the line; it is carried to the ray by the derivative of the intersection. None where the ray
/// misses the sheet.
std::optional<TriangulatedPoint> triangulate(const Rig& rig,
                                             std::size_t laser,
                                             const Eigen::Vector2d& pixel,
                                             double pixel_sigma);

}  // namespace facula
