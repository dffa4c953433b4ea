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

/// Undistort, then ray meets sheet `laser` (counted from 0) of the rig. `pixel_sigma` [px] is the
/// standard deviation of the stripe's position along x for a stripe per row, along y per column; it
/// is carried to the ray by the derivative of the intersection. None where the ray misses the sheet
/// or the distortion cannot be inverted. A rig without sheets but with a range model answers by
/// that (see triangulate_by_range()). Throws Error when the rig has no such laser.
std::optional<TriangulatedPoint> triangulate(const Rig& rig,
                                             std::size_t laser,
                                             const Eigen::Vector2d& pixel,
                                             double pixel_sigma);

}  // namespace facula
