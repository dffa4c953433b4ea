// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/simulate/laser_fan.hpp>

#include <cmath>

#include <Eigen/Geometry>

namespace facula {
namespace {

using Eigen::Vector3d;

// (1 m / r)^p; the usual powers without pow().
double inverse_power(double r, double p) {
  if (p == 0) return 1;
  if (p == 1) return 1 / r;
  return std::pow(r, -p);
}

// The camera's z axis laid into the plane; for a plane square to it, the image's x axis.
Vector3d middle_of_fan(const Vector3d& normal) {
  const Vector3d z = normal.cross(Vector3d::UnitZ().cross(normal));
  if (z.norm() >= 1e-3) return z.normalized();
  return normal.cross(Vector3d::UnitX().cross(normal)).normalized();
}

LaserFan fan_of(const LaserPlane& plane, const Vector3d& start, const SimulateOptions& options) {
  LaserFan fan;
  fan.normal = plane.normal.normalized();
  fan.axis = middle_of_fan(fan.normal);
  fan.side = fan.normal.cross(fan.axis);
  const double distance = plane.distance / plane.normal.norm();
  fan.origin = start - (fan.normal.dot(start) - distance) * fan.normal;
  fan.bend = std::tan(plane.bow);
  fan.start_half_width = options.line_half_width;
  fan.divergence = options.line_divergence;
  fan.beam = options.beam;
  fan.peak = options.laser_peak;
  fan.falloff = options.exposure_falloff;
  return fan;
}

}  // namespace

Vector3d beside_camera(const LaserPlane& sheet) {
  const Eigen::Vector2d across = sheet.normal.head<2>();
  if (across.squaredNorm() < 1e-4) return sheet.distance * sheet.normal;
  Vector3d origin = Vector3d::Zero();
  origin.head<2>() = sheet.distance / across.squaredNorm() * across;
  return origin;
}

Vector3d LaserFan::ray(double angle) const {
  const double forward = std::cos(angle);
  return (forward * axis + std::sin(angle) * side + bend * (1 - forward) * normal).normalized();
}

// Height over the cone along the normal, divided by the steepness of the cone there: its slope is
// bend (1 - cos t) along a ray and bend sin t across.
double LaserFan::off_cone(const Vector3d& from_origin, double off_plane) const {
  const double forward = axis.dot(from_origin);
  const double sideways = side.dot(from_origin);
  const double reach = std::hypot(forward, sideways);
  if (reach == 0) return off_plane;
  const double along_slope = bend * (1 - forward / reach);
  const double across_slope = bend * sideways / reach;
  const double steepness = std::sqrt(1 + along_slope * along_slope + across_slope * across_slope);
  return (off_plane - along_slope * reach) / steepness;
}

double LaserFan::middle_signal(const Vector3d& x, const Vector3d& surface_normal) const {
  const Vector3d to_laser = origin - x;
  const double r = to_laser.norm();
  const double cosine = surface_normal.dot(to_laser) / r;
  if (!(cosine > 0)) return 0;
  return peak * cosine * inverse_power(r, falloff) * half_width(1.0) / half_width(r);
}

double LaserFan::signal(const Vector3d& x, const Vector3d& surface_normal) const {
  const double u = standard_deviations(x);
  return middle_signal(x, surface_normal) * std::exp(-0.5 * u * u);
}

double line_sigma(const LaserFan& fan, double focal_length, const Vector3d& x) {
  return std::hypot(focal_length * fan.half_width((x - fan.origin).norm()) / x.z(),
                    std::sqrt(1.0 / 12));
}

LaserFan laser_fan(const Rig& rig, const SimulateOptions& options) {
  rig.check();
  options.check();
  require(options.laser < rig.lasers.size(),
          "the rig has ",
          rig.lasers.size(),
          " laser sheet(s), but sheet ",
          options.laser,
          " (counted from 0) was asked for");
  const LaserPlane& plane = rig.lasers[options.laser];
  return fan_of(plane, plane.bow == 0 ? options.laser_origin : beside_camera(plane), options);
}

std::vector<LaserFan> lit_fans(const Rig& rig, const SimulateOptions& options) {
  std::vector<LaserFan> fans = {laser_fan(rig, options)};
  for (std::size_t i = 0; options.all_lasers && i < rig.lasers.size(); ++i) {
    if (i == options.laser) continue;
    fans.push_back(fan_of(rig.lasers[i], beside_camera(rig.lasers[i]), options));
  }
  return fans;
}

}  // namespace facula
