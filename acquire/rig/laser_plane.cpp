// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/rig/laser_plane.hpp>

#include <cmath>

namespace facula {

Eigen::Vector3d LaserPlane::fan_origin() const {
  const Eigen::Vector2d across = normal.head<2>();
  if (across.squaredNorm() < 1e-4) return distance * normal;
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  origin.head<2>() = distance / across.squaredNorm() * across;
  return origin;
}

Eigen::Vector3d LaserPlane::fan_axis() const {
  const Eigen::Vector3d z = Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d in_plane = z - normal.z() * normal;
  // Square to the camera's axis every direction is as good: take the image's x.
  if (in_plane.norm() < 1e-3) return (Eigen::Vector3d::UnitX() - normal.x() * normal).normalized();
  return in_plane.normalized();
}

double LaserPlane::sheet_distance(const Eigen::Vector3d& x) const {
  const double from_plane = normal.dot(x) - distance;
  if (bow == 0) return from_plane;
  const Eigen::Vector3d rho = x - fan_origin();
  const Eigen::Vector3d in_plane = rho - normal.dot(rho) * normal;
  return from_plane - std::tan(bow) * (in_plane.norm() - in_plane.dot(fan_axis()));
}

std::optional<Eigen::Vector3d> LaserPlane::intersect(const Eigen::Vector3d& direction) const {
  const double approach = normal.dot(direction);
  if (std::abs(approach) < 1e-9 * direction.norm()) return std::nullopt;
  double t = distance / approach;
  if (!(t > 0)) return std::nullopt;
  if (bow == 0) return t * direction;
  // Newton from the plane; the cone leaves it by a few per cent of the fan's width at most.
  for (int i = 0; i < 8; ++i) {
    const double h = 1e-6 * t;
    const double off = sheet_distance(t * direction);
    const double slope = (sheet_distance((t + h) * direction) - off) / h;
    if (std::abs(slope) < 1e-9 * direction.norm()) return std::nullopt;
    const double step = off / slope;
    t -= step;
    if (!(t > 0)) return std::nullopt;
    if (std::abs(step) < 1e-13 * t) break;
  }
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
  require(std::abs(bow) < 0.2, "laser '", name, "' bow_deg: expected less than 11 degrees");
}

}  // namespace facula
