// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/simulate/triangle_distance.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

namespace facula {
namespace {

using Eigen::Vector3d;

double distance_to_segment(const Vector3d& a, const Vector3d& b, const Vector3d& x) {
  const Vector3d edge = b - a;
  const double length2 = edge.squaredNorm();
  const double along = length2 > 0 ? std::clamp((x - a).dot(edge) / length2, 0.0, 1.0) : 0.0;
  return (x - a - along * edge).norm();
}

}  // namespace

double distance_to_triangle(const std::array<Vector3d, 3>& corners, const Vector3d& x) {
  const Vector3d normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
  bool above_all_edges = normal.squaredNorm() > 0;
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector3d& a = corners[i];
    const Vector3d& b = corners[(i + 1) % 3];
    nearest = std::min(nearest, distance_to_segment(a, b, x));
    above_all_edges = above_all_edges && normal.dot((b - a).cross(x - a)) >= 0;
  }
  return above_all_edges ? std::abs(normal.dot(x - corners[0])) / normal.norm() : nearest;
}

}  // namespace facula
