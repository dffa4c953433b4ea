// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/reconstruct/measure/plane.hpp>

#include <cstddef>
#include <vector>

namespace facula {

/// How round the points of a plane lie.
struct PlaneBend {
  double angle = 0;  ///< by which the surface turns from one side of the points to the other [rad]
  double share = 0;  ///< of the variance about the plane that the bend explains [0..1]
};

/// Fits z = a + b s + c t + d s^2 + e s t + f t^2 over the plane to some of the points at
/// `indices` and takes its principal curvatures times the points' reach. A slice of a round pot
/// turns by 4 sqrt(h / R), h the inlier distance, and its bend explains most of what is left.
PlaneBend bend_of(const PointCloud& cloud,
                  const std::vector<std::size_t>& indices,
                  const Plane& plane);

}  // namespace facula
