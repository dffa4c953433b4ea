// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/reconstruct/register/scan_project.hpp>
#include <facula/tests/reconstruct/surfaces.hpp>

#include <cstdint>

namespace facula {

/// exp_se3 of (translation [m], rotation [rad]).
inline RigidTransform twist(double tx, double ty, double tz, double rx, double ry, double rz) {
  return exp_se3((Eigen::Matrix<double, 6, 1>() << tx, ty, tz, rx, ry, rz).finished());
}

inline PosedCloud scan_of(const char* name, PointCloud cloud, const Eigen::Vector3f& origin) {
  PosedCloud scan;
  scan.name = name;
  scan.cloud = std::move(cloud);
  scan.cloud.sensor_origin.assign(scan.cloud.size(), origin);
  return scan;
}

/// Floor, two walls and a slanted board: holds all six directions. Seen from (1.2, 1.2, 1.2).
inline PosedCloud corner_scan(std::uint64_t seed, std::size_t points_per_patch, double sigma) {
  Random random(seed);
  PointCloud cloud;
  add_patch(cloud, {{0, 0, 0}, {2, 0, 0}, {0, 2, 0}}, points_per_patch, sigma, random);
  add_patch(cloud, {{0, 0, 0}, {0, 2, 0}, {0, 0, 1.5}}, points_per_patch, sigma, random);
  add_patch(cloud, {{0, 0, 0}, {2, 0, 0}, {0, 0, 1.5}}, points_per_patch, sigma, random);
  add_patch(
      cloud, {{1, 0.2, 0}, {0.6, 0.3, 0}, {-0.2, 0.3, 0.5}}, points_per_patch / 4, sigma, random);
  return scan_of("corner", std::move(cloud), {1.2F, 1.2F, 1.2F});
}

/// One flat patch seen from above.
inline PosedCloud patch_scan(const Patch& patch, std::uint64_t seed) {
  Random random(seed);
  PointCloud cloud;
  add_patch(cloud, patch, 4000, 0.001, random);
  return scan_of("patch", std::move(cloud), {0, 0, 3});
}

/// Floor, ceiling and two walls of a corridor 8 m long, 2 m wide and high, seen from its middle.
inline PosedCloud corridor_scan(std::uint64_t seed, const Eigen::Vector3d& along, double sigma) {
  Random random(seed);
  const Eigen::Vector3d across = Eigen::Vector3d::UnitZ().cross(along);
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d corner = -4 * along - across - up;
  PointCloud cloud;
  add_patch(cloud, {corner, 8 * along, 2 * across}, 6000, sigma, random);
  add_patch(cloud, {corner + 2 * up, 8 * along, 2 * across}, 6000, sigma, random);
  add_patch(cloud, {corner, 8 * along, 2 * up}, 6000, sigma, random);
  add_patch(cloud, {corner + 2 * across, 8 * along, 2 * up}, 6000, sigma, random);
  return scan_of("corridor", std::move(cloud), {0, 0, 0});
}

/// A whole ball, without sensor origins: nobody knows its outside.
inline PosedCloud ball_scan(std::size_t count, const Eigen::Vector3f& centre, double radius) {
  PosedCloud scan;
  scan.name = "ball";
  scan.cloud = sphere_points(count, radius);
  for (Eigen::Vector3f& p : scan.cloud.points) p += centre;
  return scan;
}

}  // namespace facula
