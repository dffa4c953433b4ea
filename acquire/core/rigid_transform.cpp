// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/rigid_transform.hpp>

#include <cmath>

#include <Eigen/SVD>

namespace facula {
namespace {

Eigen::Matrix3d skew(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

/// Left Jacobian of SO(3), which carries the twist's translational part into the translation.
Eigen::Matrix3d left_jacobian(const Eigen::Vector3d& rotation_vector) {
  const double angle = rotation_vector.norm();
  const Eigen::Matrix3d k = skew(rotation_vector);
  if (angle < 1e-6) return Eigen::Matrix3d::Identity() + 0.5 * k + k * k / 6.0;
  const double a = (1 - std::cos(angle)) / (angle * angle);
  const double b = (angle - std::sin(angle)) / (angle * angle * angle);
  return Eigen::Matrix3d::Identity() + a * k + b * k * k;
}

Eigen::Vector3d rotation_vector_of(const Eigen::Quaterniond& q) {
  const double sign = q.w() < 0 ? -1 : 1;
  const Eigen::Vector3d v = sign * q.vec();
  const double sine = v.norm();
  if (sine < 1e-12) return 2 * v;
  return v * (2 * std::atan2(sine, sign * q.w()) / sine);
}

}  // namespace

RigidTransform RigidTransform::from_rotation(const Eigen::Matrix3d& rotation) {
  require(rotation.allFinite() &&
              (rotation.transpose() * rotation - Eigen::Matrix3d::Identity()).norm() < 1e-3 &&
              rotation.determinant() > 0,
          "expected a rotation matrix (orthonormal, determinant +1), got one with determinant ",
          rotation.determinant(),
          "; check its nine numbers and their order");
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(rotation, Eigen::ComputeFullU | Eigen::ComputeFullV);
  RigidTransform result;
  result.rotation =
      Eigen::Quaterniond(Eigen::Matrix3d(svd.matrixU() * svd.matrixV().transpose())).normalized();
  return result;
}

RigidTransform RigidTransform::from_matrix(const Eigen::Matrix4d& matrix) {
  require((matrix.row(3) - Eigen::RowVector4d(0, 0, 0, 1)).norm() < 1e-9,
          "expected a pose matrix whose last row is 0 0 0 1, got ",
          matrix.row(3));
  RigidTransform result = from_rotation(matrix.topLeftCorner<3, 3>());
  result.translation = matrix.topRightCorner<3, 1>();
  return result;
}

Eigen::Matrix4d RigidTransform::matrix() const {
  Eigen::Matrix4d m = Eigen::Matrix4d::Identity();
  m.topLeftCorner<3, 3>() = rotation.toRotationMatrix();
  m.topRightCorner<3, 1>() = translation;
  return m;
}

RigidTransform RigidTransform::inverse() const {
  const Eigen::Quaterniond back = rotation.conjugate();
  return {back, back * -translation};
}

Eigen::Vector3d RigidTransform::operator*(const Eigen::Vector3d& x_in_source) const {
  return rotation * x_in_source + translation;
}

RigidTransform operator*(const RigidTransform& a_from_b, const RigidTransform& b_from_c) {
  return {(a_from_b.rotation * b_from_c.rotation).normalized(), a_from_b * b_from_c.translation};
}

RigidTransform exp_se3(const Eigen::Matrix<double, 6, 1>& twist) {
  const Eigen::Vector3d rotation_vector = twist.tail<3>();
  const double angle = rotation_vector.norm();
  RigidTransform result;
  if (angle > 0) {
    result.rotation =
        Eigen::Quaterniond(Eigen::AngleAxisd(angle, rotation_vector / angle)).normalized();
  }
  result.translation = left_jacobian(rotation_vector) * twist.head<3>();
  return result;
}

Eigen::Matrix<double, 6, 1> log_se3(const RigidTransform& target_from_source) {
  const Eigen::Vector3d rotation_vector = rotation_vector_of(target_from_source.rotation);
  Eigen::Matrix<double, 6, 1> twist;
  twist << left_jacobian(rotation_vector).inverse() * target_from_source.translation,
      rotation_vector;
  return twist;
}

double rotation_angle(const RigidTransform& target_from_source) {
  return rotation_vector_of(target_from_source.rotation).norm();
}

}  // namespace facula
