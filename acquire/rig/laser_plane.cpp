// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/rig/laser_plane.hpp>

#include <cmath>

namespace facula {

std::optional<Eigen::Vector3d> LaserPlane::intersect(const Eigen::Vector3d& direction) const {
  const double approach = normal.dot(direction);
  if (std::abs(approach) < 1e-9 * direction.norm()) return std::nullopt;
  const double t = distance / approach;
  if (!(t > 0)) return std::nullopt;
  return t * direction;
}

void LaserPlane::check() const {
  require(normal.allFinite() && std::abs(normal.norm() - 1) < 1e-3,
          "laser '",
          name,
          "' normal: expected a vector of length 1, got length ",
          normal.norm());
  require(std::isfinite(distance), "laser '", name, "' distance_mm: expected a number, got NaN");
  require(std::abs(distance) > 1e-6,
          "laser '",
          name,
          "': its plane passes through the camera centre (distance ",
          distance * 1000,
          " mm), so that no depth can be measured; check normal and distance_mm");
}

}  // namespace facula
