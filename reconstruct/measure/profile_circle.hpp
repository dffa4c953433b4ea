// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/reconstruct/measure/primitive_fit.hpp>
#include <facula/reconstruct/measure/profile_section.hpp>

#include <Eigen/Core>

namespace facula {

/// The circle through a section of a rod.
struct CircleFit {
  Eigen::Vector2d center = Eigen::Vector2d::Zero();  ///< (across, height) [m]
  double radius = 0;                                 ///< [m]
  double radius_sigma = 0;                           ///< 1 standard deviation [m]
  PrimitiveQuality quality;                          ///< covariance of (center, radius)
};

/// Geometric least squares over all points of the section, weighted by sigma, from the algebraic
/// circle (Kasa 1976). A rod cut at an angle is an ellipse: cut square to its axis, or fit a
/// cylinder. Throws Error for fewer than three points or points on one line.
CircleFit fit_circle(const ProfileSection& section);

}  // namespace facula
