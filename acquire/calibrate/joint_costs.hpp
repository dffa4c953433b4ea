// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/calibrate/joint_residuals.hpp>

#include <Eigen/Core>

namespace facula {

/// What a residual needs of the state at the start.
struct JointBase {
  const JointState& state;
  const JointSight& sight;
  double position;
};

struct PointCost {
  JointBase base;
  const JointPoint& point;
  double sigma;

  template <typename T>
  bool finish(const Vector3T<T>& x, const T* camera, T* residual) const {
    if (!(x.z() > T(1e-6))) return false;
    const Vector2T<T> at =
        projected<T>(base.state.rig.camera, camera, x.template head<2>() / x.z());
    residual[0] = (at.x() - point.pixel.x()) / sigma;
    residual[1] = (at.y() - point.pixel.y()) / sigma;
    return true;
  }

  template <typename T>
  Vector3T<T> in_target(const T* pose, const T* scale) const {
    const T size = base.state.scales[base.sight.board] + scale[0];
    return posed<T>(base.state.poses[base.sight.pose], pose, size * point.on_board.cast<T>());
  }

  template <typename T>
  bool operator()(const T* camera, const T* pose, const T* scale, T* residual) const {
    return finish<T>(in_target(pose, scale), camera, residual);
  }

  template <typename T>
  bool operator()(const T* camera,
                  const T* pose,
                  const T* scale,
                  const T* axis,
                  const T* position,
                  T* residual) const {
    const T q = base.position + position[0];
    const Vector3T<T> x =
        camera_from_scan<T>(base.state.rig.axis, axis, q, in_target(pose, scale), false);
    return finish<T>(x, camera, residual);
  }
};

struct LineCost {
  JointBase base;
  const JointLinePoint& point;
  Eigen::Vector2d normalized;  ///< of the pixel, at the start
  Eigen::Matrix2d back;        ///< from pixels to normalized, at the start
  double metres_sigma;         ///< of the distance off the sheet
  bool bends;                  ///< whether the sheet is a cone

  /// `normal` and `through`: the board's plane in the camera frame.
  template <typename T>
  bool finish(const Vector3T<T>& normal,
              const Vector3T<T>& through,
              const T* camera,
              const T* laser,
              T* residual) const {
    // One Newton step from the undistorted pixel at the start: exact to first order.
    const Vector2T<T> start = normalized.cast<T>();
    const Vector2T<T> error =
        projected<T>(base.state.rig.camera, camera, start) - point.pixel.cast<T>();
    const Vector2T<T> n = start - back.cast<T>() * error;
    const Vector3T<T> ray(n.x(), n.y(), T(1));
    const T approach = normal.dot(ray);
    if (approach == T(0)) return false;
    const Vector3T<T> x = ray * (normal.dot(through) / approach);
    residual[0] =
        distance_off_sheet<T>(base.state.rig.lasers[point.laser], laser, x, bends) / metres_sigma;
    return true;
  }

  template <typename T>
  bool operator()(const T* camera, const T* laser, const T* pose, T* residual) const {
    const RigidTransform& p = base.state.poses[base.sight.pose];
    return finish<T>(posed_direction<T>(p, pose, Eigen::Vector3d::UnitZ().cast<T>()),
                     posed<T>(p, pose, Vector3T<T>::Zero()),
                     camera,
                     laser,
                     residual);
  }

  template <typename T>
  bool operator()(const T* camera,
                  const T* laser,
                  const T* pose,
                  const T* axis,
                  const T* position,
                  T* residual) const {
    const RigidTransform& p = base.state.poses[base.sight.pose];
    const Axis& a = base.state.rig.axis;
    const T q = base.position + position[0];
    const Vector3T<T> normal = posed_direction<T>(p, pose, Eigen::Vector3d::UnitZ().cast<T>());
    const Vector3T<T> through = posed<T>(p, pose, Vector3T<T>::Zero());
    return finish<T>(camera_from_scan<T>(a, axis, q, normal, true),
                     camera_from_scan<T>(a, axis, q, through, false),
                     camera,
                     laser,
                     residual);
  }
};

/// A number that is known to be 0 within sigma.
struct PriorCost {
  double offset;  ///< of the number from its known value, at the start
  double sigma;
  template <typename T>
  bool operator()(const T* value, T* residual) const {
    residual[0] = (offset + value[0]) / sigma;
    return true;
  }
};

}  // namespace facula
