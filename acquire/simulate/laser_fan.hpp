// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/rig/rig.hpp>
#include <facula/acquire/simulate/simulate.hpp>

#include <vector>

#include <Eigen/Core>

namespace facula {

/// The light that leaves the laser: a fan from one point, thin and Gaussian across. Camera frame.
/// Its rays leave the origin along
///   cos(t) axis + sin(t) side + tan(bow) (1 - cos(t)) normal:
/// the generators of the cone that laser_plane.hpp defines, a plane where bow is 0.
struct LaserFan {
  Eigen::Vector3d origin;            ///< where the fan starts [m]
  Eigen::Vector3d normal;            ///< of the sheet's plane, unit [1]
  Eigen::Vector3d axis;              ///< middle of the fan, unit, in the plane [1]
  Eigen::Vector3d side;              ///< unit, square to both [1]
  double bend = 0;                   ///< tan(bow) [1]
  double start_half_width = 0;       ///< 1 standard deviation at the origin [m]
  double divergence = 0;             ///< growth of the half width with distance [rad]
  std::optional<GaussianBeam> beam;  ///< instead of these two
  double peak = 0;     ///< signal of white, square to the light, 1 m from the origin [DN]
  double falloff = 0;  ///< power of distance [1]

  /// Unit direction of the ray at an angle from the axis [rad].
  Eigen::Vector3d ray(double angle) const;

  /// Signed distance of a point from the sheet's middle [m]; of a sheet that bows, to first order.
  double sheet_distance(const Eigen::Vector3d& x) const {
    const Eigen::Vector3d from_origin = x - origin;
    const double off_plane = normal.dot(from_origin);
    return bend == 0 ? off_plane : off_cone(from_origin, off_plane);
  }

  /// Standard deviation across the sheet at a distance from the origin [m].
  double half_width(double from_origin) const {
    return beam ? beam->half_width(from_origin) : start_half_width + divergence * from_origin;
  }

  /// Distance of a point from the sheet's middle in standard deviations of its light [1].
  double standard_deviations(const Eigen::Vector3d& x) const {
    return sheet_distance(x) / half_width((x - origin).norm());
  }

  /// Signal of a white surface at `x` with unit `surface_normal`, lit or not by the fan's middle:
  /// everything but albedo, shadow and the Gaussian across the sheet [DN]. 0 when it looks away.
  double middle_signal(const Eigen::Vector3d& x, const Eigen::Vector3d& surface_normal) const;

  /// The same with the Gaussian across the sheet [DN].
  double signal(const Eigen::Vector3d& x, const Eigen::Vector3d& surface_normal) const;

 private:
  double off_cone(const Eigen::Vector3d& from_origin, double off_plane) const;
};

/// Width of the line in the image where the light meets a surface square to the camera, the pixel's
/// area included, 1 standard deviation [px].
double line_sigma(const LaserFan& fan, double focal_length, const Eigen::Vector3d& x);

/// The fan of sheet options.laser. Checks rig and options; throws Error when the rig has no such
/// sheet.
LaserFan laser_fan(const Rig& rig, const SimulateOptions& options);

/// The fans of all sheets that are lit, that of options.laser first.
std::vector<LaserFan> lit_fans(const Rig& rig, const SimulateOptions& options);

/// The sheet's point nearest to the camera centre within the plane z = 0 (nearest at all for a
/// sheet nearly square to the camera's axis): where light starts if nobody says otherwise.
Eigen::Vector3d beside_camera(const LaserPlane& sheet);

}  // namespace facula
