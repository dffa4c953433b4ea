// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/range/polar_solution.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace facula {

PolarSolution::Polar PolarSolution::solve(double px, double row) const {
  const double q = slope / (direction * (px - vanishing));  // (2.10), O'P'
  if (!(q > 0)) return {std::nan(""), std::nan(""), std::nan("")};
  const double pitch = std::atan((row - middle_row) / focal_length_px);  // (2.11)
  const double foot_to_point = q / std::cos(pitch);                      // (2.12), O'P
  const double foot_to_laser = q * std::tan(laser_angle);                // (2.13), O'L
  const double laser_to_point = std::hypot(q, foot_to_laser);            // (2.14), P'L
  const double pole_to_foot = std::abs(pole_to_laser - foot_to_laser);   // O O'
  const double pole_to_flat = std::hypot(pole_to_foot, q);               // (2.15), OP'
  const double cosine = (pole_to_laser * pole_to_laser + pole_to_flat * pole_to_flat -
                         laser_to_point * laser_to_point) /
                        (2 * pole_to_laser * pole_to_flat);
  const double yaw = std::numbers::pi / 2 - std::acos(std::clamp(cosine, -1.0, 1.0));  // (2.16)
  return {std::hypot(pole_to_foot, foot_to_point), yaw, pitch};  // (2.17), see above
}

Eigen::Vector3d PolarSolution::cartesian(const Polar& polar) {
  // yaw lies in the plane through the baseline and P', pitch lifts P' to P: x = z tan(yaw),
  // y = z tan(pitch).
  const Eigen::Vector3d direction(std::tan(polar.yaw), std::tan(polar.pitch), 1);
  return polar.range * direction.normalized();
}

void PolarSolution::check() const {
  for (const double value : {focal_length_px, slope, pole_to_laser}) {
    require(value > 0 && std::isfinite(value),
            "expected focal length, slope and the pole's distance from the laser above 0, got ",
            value);
  }
  require(direction == 1 || direction == -1, "expected a direction of 1 or -1, got ", direction);
  require(std::abs(laser_angle) < std::numbers::pi / 2,
          "expected the laser within 90 degrees of the perpendicular, got ",
          laser_angle * 180 / std::numbers::pi);
  require(std::isfinite(vanishing) && std::isfinite(middle_row),
          "expected a finite vanishing position and middle row");
}

}  // namespace facula
