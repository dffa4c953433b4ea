// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/point_cloud.hpp>
#include <facula/acquire/core/random.hpp>

#include <cmath>
#include <cstdint>

namespace facula {

/// `count` points spread evenly over a sphere (Fibonacci lattice).
inline PointCloud sphere_points(std::size_t count, double radius) {
  PointCloud cloud;
  const double golden = M_PI * (3 - std::sqrt(5.0));
  for (std::size_t i = 0; i < count; ++i) {
    const double z = 1 - (2 * static_cast<double>(i) + 1) / static_cast<double>(count);
    const double r = std::sqrt(1 - z * z);
    const double a = golden * static_cast<double>(i);
    const Eigen::Vector3d p(r * std::cos(a), r * std::sin(a), z);
    cloud.points.push_back((radius * p).cast<float>());
  }
  return cloud;
}

/// A rectangle: corner + u * side_u + v * side_v, u and v in [0, 1).
struct Patch {
  Eigen::Vector3d corner;
  Eigen::Vector3d side_u;
  Eigen::Vector3d side_v;
};

/// Random points on a patch, moved along its normal by normal noise of standard deviation `sigma`.
inline void add_patch(
    PointCloud& cloud, const Patch& patch, std::size_t count, double sigma, Random& random) {
  const Eigen::Vector3d normal = patch.side_u.cross(patch.side_v).normalized();
  for (std::size_t i = 0; i < count; ++i) {
    const double u = random.uniform();
    const double v = random.uniform();
    const double noise = sigma > 0 ? sigma * random.normal() : 0;
    const Eigen::Vector3d p = patch.corner + u * patch.side_u + v * patch.side_v + noise * normal;
    cloud.points.push_back(p.cast<float>());
  }
}

}  // namespace facula
