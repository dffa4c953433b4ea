// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/point_cloud.hpp>
#include <facula/acquire/core/rigid_transform.hpp>

#include <cstddef>

#include <Eigen/Core>

namespace facula {

struct IcpOptions {
  double max_distance =
      0.3;  ///< correspondences farther apart are not used, at the start [m], above 0
  double min_max_distance = 0.05;     ///< the bound shrinks to this as the clouds meet [m]
  int max_iterations = 150;           ///< [1], at least 1
  double rotation_epsilon = 1e-6;     ///< converged when a step turns less [rad]
  double translation_epsilon = 1e-6;  ///< and moves less [m]
  double significance = 0.01;         ///< or when a step is this much of the pose's own sigma [1]
  double max_normal_angle = 0.8;      ///< between the two normals of a correspondence [rad]
  int num_threads = 0;                ///< 0 = all cores [1]

  void check() const;
};

struct IcpResult {
  RigidTransform target_from_source;
  bool converged = false;
  int iterations = 0;       ///< [1]
  std::size_t inliers = 0;  ///< correspondences of the last step [1]
  double overlap = 0;       ///< share of source points with a correspondence [0..1]
  double rms = 0;           ///< point-to-plane distance over the inliers [m]

  /// Of the twist e = (translation [m], rotation [rad]) in true pose = exp_se3(e) * estimate, from
  /// the residuals' own scatter. Holds for errors that differ from point to point; what both clouds
  /// share (a bent scanner, a wrong scale) does not show in it.
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
};

/// Point-to-plane ICP (Chen and Medioni 1992) by Gauss-Newton with a robust (Geman-McClure) weight.
/// `target` needs normals. Where both clouds have normals, those of a pair must agree; sides count
/// only where both have sensor origins. Throws Error when either cloud is empty or the overlap is
/// too small to decide the pose.
IcpResult register_icp(const PointCloud& source,
                       const PointCloud& target,
                       const RigidTransform& target_from_source_guess,
                       const IcpOptions& options = {});

}  // namespace facula
