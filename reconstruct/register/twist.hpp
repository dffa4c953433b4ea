// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/rigid_transform.hpp>

#include <Eigen/Core>

namespace facula {

/// A small motion as exp_se3() takes it: (translation [m], rotation vector [rad]).
using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

/// cross_matrix(v) * x = v x x.
Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& v);

/// Carries twists of the source frame into the target frame: to first order
/// exp_se3(adjoint_of(pose) * e) * pose = pose * exp_se3(e).
Matrix6 adjoint_of(const RigidTransform& target_from_source);

/// The same for frames that differ by a shift: twists about the origin as twists about `pivot`.
Matrix6 about(const Eigen::Vector3d& pivot);

/// Motion of a point at `arm` from the pivot by a twist about the pivot.
Eigen::Matrix<double, 3, 6> pose_jacobian(const Eigen::Vector3d& arm);

/// A twist about `pivot` as a transform.
RigidTransform turn_about(const Eigen::Vector3d& pivot, const Vector6& twist);

}  // namespace facula
