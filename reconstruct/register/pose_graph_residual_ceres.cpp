// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/reconstruct/register/pose_graph_residual.hpp>

#include <Eigen/Geometry>
#include <ceres/autodiff_cost_function.h>
#include <ceres/rotation.h>

namespace facula {
namespace {

template <typename T>
using Vector3 = Eigen::Matrix<T, 3, 1>;

template <typename T>
struct Pose {
  Eigen::Quaternion<T> rotation;
  Vector3<T> translation;
};

template <typename T>
Pose<T> changed(const RigidTransform& pose, const T* change) {
  T turn[4];  // w x y z
  ceres::AngleAxisToQuaternion(change + 3, turn);
  const Eigen::Quaternion<T> rotation(turn[0], turn[1], turn[2], turn[3]);
  const Vector3<T> shift(change[0], change[1], change[2]);
  return {rotation * pose.rotation.cast<T>(), rotation * pose.translation.cast<T>().eval() + shift};
}

/// log_se3() for numbers that carry derivatives.
template <typename T>
Eigen::Matrix<T, 6, 1> log_of(const Pose<T>& pose) {
  const T quaternion[4] = {
      pose.rotation.w(), pose.rotation.x(), pose.rotation.y(), pose.rotation.z()};
  Vector3<T> w;
  ceres::QuaternionToAngleAxis(quaternion, w.data());
  const T angle2 = w.squaredNorm();
  // Inverse of the left Jacobian: I - W / 2 + c W^2.
  T c(1.0 / 12);
  if (angle2 > T(1e-8)) {
    using std::sqrt;
    using std::tan;
    const T half = sqrt(angle2) / T(2);
    c = (T(1) - half / tan(half)) / angle2;
  }
  const Vector3<T>& t = pose.translation;
  const Vector3<T> wt = w.cross(t);
  Eigen::Matrix<T, 6, 1> twist;
  twist << t - wt / T(2) + c * w.cross(wt), w;
  return twist;
}

struct EdgeResidualFunctor {
  RigidTransform from;
  RigidTransform to;
  RigidTransform from_from_to;
  Eigen::Matrix<double, 6, 6> root;

  template <typename T>
  bool operator()(const T* from_change, const T* to_change, T* residual) const {
    const Pose<T> a = changed(from, from_change);
    const Pose<T> b = changed(to, to_change);
    const Eigen::Quaternion<T> back = b.rotation.conjugate();
    const Eigen::Quaternion<T> turn = back * a.rotation;
    const Vector3<T> shift = back * (a.translation - b.translation);
    const Pose<T> off{turn * from_from_to.rotation.cast<T>(),
                      turn * from_from_to.translation.cast<T>().eval() + shift};
    Eigen::Map<Eigen::Matrix<T, 6, 1>> out(residual);
    out = root.cast<T>() * log_of(off);
    return true;
  }
};

}  // namespace

RigidTransform moved(const RigidTransform& pose, const std::array<double, 6>& change) {
  const Pose<double> p = changed(pose, change.data());
  return {p.rotation.normalized(), p.translation};
}

ceres::CostFunction* pose_edge_cost(const RigidTransform& from,
                                    const RigidTransform& to,
                                    const RigidTransform& to_from_from,
                                    const Eigen::Matrix<double, 6, 6>& root) {
  return new ceres::AutoDiffCostFunction<EdgeResidualFunctor, 6, 6, 6>(
      new EdgeResidualFunctor{from, to, to_from_from.inverse(), root});
}

}  // namespace facula
