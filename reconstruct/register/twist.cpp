// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/reconstruct/register/twist.hpp>

namespace facula {

Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

Matrix6 adjoint_of(const RigidTransform& target_from_source) {
  const Eigen::Matrix3d r = target_from_source.rotation.toRotationMatrix();
  Matrix6 adjoint = Matrix6::Zero();
  adjoint.topLeftCorner<3, 3>() = r;
  adjoint.bottomRightCorner<3, 3>() = r;
  adjoint.topRightCorner<3, 3>() = cross_matrix(target_from_source.translation) * r;
  return adjoint;
}

Matrix6 about(const Eigen::Vector3d& pivot) {
  Matrix6 map = Matrix6::Identity();
  map.topRightCorner<3, 3>() = -cross_matrix(pivot);
  return map;
}

Eigen::Matrix<double, 3, 6> pose_jacobian(const Eigen::Vector3d& arm) {
  Eigen::Matrix<double, 3, 6> j;
  j << Eigen::Matrix3d::Identity(), -cross_matrix(arm);
  return j;
}

RigidTransform turn_about(const Eigen::Vector3d& pivot, const Vector6& twist) {
  const RigidTransform from_pivot{Eigen::Quaterniond::Identity(), pivot};
  return from_pivot * exp_se3(twist) * from_pivot.inverse();
}

}  // namespace facula
