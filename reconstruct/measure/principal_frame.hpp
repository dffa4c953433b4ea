// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/point_cloud.hpp>

#include <vector>

#include <Eigen/Core>

namespace facula {

/// Mean and principal axes of points. The last axis is the normal of their least-squares plane.
struct PrincipalFrame {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();    ///< the mean [m]
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  ///< rows, longest first, right-handed [1]
  Eigen::Vector3d mean_squares = Eigen::Vector3d::Zero();  ///< along the axes [m^2]

  Eigen::Vector3d local(const Eigen::Vector3d& x) const { return axes * (x - origin); }
};

/// Every point counts the same. The same result for every number of threads. Throws Error for no
/// points or points that are not finite.
PrincipalFrame principal_frame(const std::vector<Eigen::Vector3d>& points, int num_threads = 0);

/// Whether the cloud's finite points lie neither on one line nor in one spot, as far as their
/// digits tell: only then is there a plane through them, and a side to be on.
bool spans_surface(const PointCloud& cloud);

}  // namespace facula
