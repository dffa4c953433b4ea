// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/simulate/laser_fan.hpp>

#include <cmath>

namespace facula {
namespace {

// (1 m / r)^p; the usual powers without pow().
double inverse_power(double r, double p) {
  if (p == 0) return 1;
  if (p == 1) return 1 / r;
  return std::pow(r, -p);
}

}  // namespace

double LaserFan::middle_signal(const Eigen::Vector3d& x,
                               const Eigen::Vector3d& surface_normal) const {
  const Eigen::Vector3d to_laser = origin - x;
  const double r = to_laser.norm();
  const double cosine = surface_normal.dot(to_laser) / r;
  if (!(cosine > 0)) return 0;
  return peak * cosine * inverse_power(r, falloff) * half_width(1.0) / half_width(r);
}

double LaserFan::signal(const Eigen::Vector3d& x, const Eigen::Vector3d& surface_normal) const {
  const double u = sheet_distance(x) / half_width((x - origin).norm());
  return middle_signal(x, surface_normal) * std::exp(-0.5 * u * u);
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
  LaserFan fan;
  fan.normal = plane.normal.normalized();
  fan.distance = plane.distance / plane.normal.norm();
  fan.origin = options.laser_origin - fan.sheet_distance(options.laser_origin) * fan.normal;
  fan.start_half_width = options.line_half_width;
  fan.divergence = options.line_divergence;
  fan.peak = options.laser_peak;
  fan.falloff = options.exposure_falloff;
  return fan;
}

}  // namespace facula
