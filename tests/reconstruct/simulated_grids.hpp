// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/reconstruct/register/scan_project.hpp>

#include <cmath>
#include <functional>

#include <Eigen/Geometry>

namespace facula {

/// Where a scanner stands, what it looks at, and its grid of directions.
struct Viewpoint {
  Eigen::Vector3d eye;
  Eigen::Vector3d target;
  double half_angle = 0.3;  ///< of the field of view [rad]
  int cells = 100;          ///< along each side of the grid [1]
};

/// Way along a ray from `eye` in the unit direction to the surface [m]; NaN where it meets none.
using RayRange = std::function<double(const Eigen::Vector3d& eye, const Eigen::Vector3d& way)>;

/// A scan with grid and sensor origins in the scanner's own frame, and its pose.
inline PosedCloud simulated_grid(const Viewpoint& view, const RayRange& range) {
  const Eigen::Vector3d ahead = (view.target - view.eye).normalized();
  const Eigen::Vector3d right = ahead.unitOrthogonal();
  Eigen::Matrix3d world_from_scan;
  world_from_scan << right, ahead.cross(right), ahead;
  PosedCloud scan;
  scan.name = "simulated";
  scan.world_from_scan.rotation = Eigen::Quaterniond(world_from_scan);
  scan.world_from_scan.translation = view.eye;
  scan.grid.rows = scan.grid.cols = view.cells;
  for (int col = 0; col < view.cells; ++col) {
    for (int row = 0; row < view.cells; ++row) {
      const auto slope = [&](int i) {
        return std::tan(view.half_angle) * (2 * (i + 0.5) / view.cells - 1);
      };
      const Eigen::Vector3d way = Eigen::Vector3d(slope(col), slope(row), 1).normalized();
      const double r = range(view.eye, world_from_scan * way);
      scan.grid.point.push_back(std::isnan(r) ? ScanGrid::kNone
                                              : static_cast<std::int32_t>(scan.cloud.size()));
      if (std::isnan(r)) continue;
      scan.cloud.points.push_back((r * way).cast<float>());
      scan.cloud.sensor_origin.emplace_back(0.0F, 0.0F, 0.0F);
    }
  }
  return scan;
}

/// A sphere about the origin.
inline RayRange sphere_range(double radius) {
  return [radius](const Eigen::Vector3d& eye, const Eigen::Vector3d& way) {
    const double b = eye.dot(way);
    const double root = b * b - eye.squaredNorm() + radius * radius;
    return root < 0 ? NAN : -b - std::sqrt(root);
  };
}

/// The six views along the axes from `distance` away.
inline ScanProject six_views(const RayRange& range, double distance, Viewpoint view) {
  ScanProject project;
  for (int i = 0; i < 6; ++i) {
    view.eye = Eigen::Vector3d::Zero();
    view.eye[i / 2] = i % 2 == 0 ? distance : -distance;
    view.target = Eigen::Vector3d::Zero();
    project.scans.push_back(simulated_grid(view, range));
  }
  return project;
}

}  // namespace facula
