// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace facula {

/// A rotation and a translation between two frames. A variable of this type is called
/// `target_from_source` and means  x_in_target = rotation * x_in_source + translation  [m].
struct RigidTransform {
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();  ///< unit quaternion [1]
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();         ///< [m]

  static RigidTransform from_rotation(const Eigen::Matrix3d& rotation);

  /// Reads a 4x4 matrix whose upper left block is a rotation; throws Error when that block is not
  /// one to 1e-3 (it is then projected to the nearest rotation) or the last row is not 0 0 0 1.
  static RigidTransform from_matrix(const Eigen::Matrix4d& matrix);

  Eigen::Matrix4d matrix() const;
  RigidTransform inverse() const;

  Eigen::Vector3d operator*(const Eigen::Vector3d& x_in_source) const;
};

/// a_from_c = a_from_b * b_from_c.
RigidTransform operator*(const RigidTransform& a_from_b, const RigidTransform& b_from_c);

/// Exponential map of SE(3): twist = (translational part [m], rotation vector [rad]).
RigidTransform exp_se3(const Eigen::Matrix<double, 6, 1>& twist);

/// Inverse of exp_se3; the rotation vector's length lies in [0, pi].
Eigen::Matrix<double, 6, 1> log_se3(const RigidTransform& target_from_source);

/// Angle of the rotation [rad], in [0, pi].
double rotation_angle(const RigidTransform& target_from_source);

}  // namespace facula
