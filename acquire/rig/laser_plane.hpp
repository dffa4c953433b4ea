// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>

#include <Eigen/Core>

namespace facula {

/// The sheet of light: points x in the camera frame with normal . x = distance. The sheet of a real
/// line lens is a very open cone with its tip at the laser instead of a plane: with rho = x - o,
/// o = fan_origin(), a = fan_axis(), the in-plane length |rho|_p and the bow angle b,
///   normal . x - distance = tan(b) (|rho|_p - rho . a),
/// so that the plane touches the cone along the middle of the fan. b = 0 is the plane.
struct LaserPlane {
  std::string name = "laser";
  Eigen::Vector3d normal = Eigen::Vector3d::UnitX();  ///< unit length, camera frame [1]
  double distance = 0;                                ///< from the camera centre [m]
  double bow = 0;                                     ///< opening of the cone [rad], |b| < 0.2

  /// Where the light is taken to start, camera frame: the plane's point nearest to the camera
  /// centre within z = 0; the nearest point at all where the plane is nearly parallel to z = 0 [m].
  Eigen::Vector3d fan_origin() const;

  /// The middle of the fan: the camera's z axis laid into the plane, unit [1].
  Eigen::Vector3d fan_axis() const;

  /// How far a point lies off the sheet, along the normal [m].
  double sheet_distance(const Eigen::Vector3d& x) const;

  /// Where the ray from the camera centre along `direction` meets the sheet; none when it does not
  /// in front of the camera or grazes it.
  std::optional<Eigen::Vector3d> intersect(const Eigen::Vector3d& direction) const;

  /// Throws Error when the normal is not of unit length or the plane passes through the camera
  /// centre (every point of the line would then lie on one ray).
  void check() const;
};

}  // namespace facula
