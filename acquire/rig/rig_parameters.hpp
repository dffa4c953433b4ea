// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/rig/rig.hpp>

#include <string>
#include <vector>

#include <Eigen/Core>

namespace facula {

/// Names of all continuous parameters of a rig; the unit stands at the end of a name.
///   camera.fx_px fy_px cx_px cy_px k1 k2 p1 p2 k3
///   laser.<name>.turn_a_rad turn_b_rad  tilts of the normal along tangent_basis(normal)
///   laser.<name>.distance_mm bow_rad
///   axis.turn_x_rad turn_y_rad          the camera turns about the scan frame's x and y ...
///   axis.shift_x_mm shift_y_mm          ... and moves along them (pan and turntable)
///   axis.direction_a_rad direction_b_rad  tilts along tangent_basis(direction) (linear)
/// The gauge: of a pan or turntable only the axis line, four numbers, shows in any measurement.
/// Turn about it and shift along it choose the scan frame and are no parameters; nor is the whole
/// scan frame of a linear axis, where two numbers remain.
std::vector<std::string> rig_parameter_names(const Rig& rig);

/// The camera's share of those names, in the order fx fy cx cy k1 k2 p1 p2 k3.
std::vector<std::string> camera_parameter_names();

/// The rig after its parameters grew by `deltas`, one per name, in the units of the names. Turns
/// are small: they compose to first order. Throws Error on an unknown name or a wrong count.
Rig moved(const Rig& rig, const std::vector<std::string>& names, const Eigen::VectorXd& deltas);

/// The step of a parameter that moves a ray or a point by about 1e-5 of its length: fit for central
/// differences.
double parameter_step(const Rig& rig, const std::string& name);

/// Two unit vectors square to `direction` (unit) and to each other, the same for the same
/// direction.
struct TangentBasis {
  Eigen::Vector3d a;
  Eigen::Vector3d b;
};
TangentBasis tangent_basis(const Eigen::Vector3d& direction);

/// Throws Error unless the covariance fits the rig: known names, none twice, one row and column
/// each, finite, symmetric, no negative variance in any direction.
void check_covariance(const Rig& rig, const RigCovariance& covariance);

/// Standard deviation of a parameter; 0 where the rig has no covariance or does not name it.
double parameter_sigma(const Rig& rig, const std::string& name);

}  // namespace facula
