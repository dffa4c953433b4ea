// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/simulate/scene.hpp>
#include <facula/acquire/simulate/simulate.hpp>

#include <vector>

#include <Eigen/Core>

namespace facula {

/// What an object does with light, worked out once for a camera and a laser.
struct ObjectLight {
  Eigen::Vector3d ambient = Eigen::Vector3d::Zero();  ///< blue, green, red; grey: the first [DN]
  double laser_share = 0;  ///< of the laser's light that is scattered back [0..1]
  double mirror = 0;       ///< share that is reflected as by a mirror [0..1]
};

std::vector<ObjectLight> object_lights(const Scene& scene, const SimulateOptions& options);

/// How the camera's channels see the laser, the strongest being 1: blue, green, red; grey: one.
Eigen::Vector3d laser_response(const SimulateOptions& options);

/// Share of the laser's light that a surface of this colour (red, green, blue) scatters, in units
/// of its albedo [0..1].
double laser_tint(const Eigen::Vector3d& colour, LaserColour laser);

}  // namespace facula
