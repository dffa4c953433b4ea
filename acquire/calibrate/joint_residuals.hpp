// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/calibrate/joint_model.hpp>
#include <facula/acquire/rig/rig_parameters.hpp>

#include <cmath>

#include <Eigen/Core>
#include <Eigen/Geometry>

/// The joint calibration's geometry once more, for any kind of number: with dual numbers it gives
/// derivatives. Everything is a change from the state at which the solver started, in the order of
/// rig_parameters.hpp, lengths in metres.
namespace facula {

template <typename T>
using Vector2T = Eigen::Matrix<T, 2, 1>;
template <typename T>
using Vector3T = Eigen::Matrix<T, 3, 1>;

/// Rotates x by the rotation vector w; exact, with derivatives also at w = 0.
template <typename T>
Vector3T<T> turned_by(const Vector3T<T>& w, const Vector3T<T>& x) {
  using std::cos;
  using std::sin;
  using std::sqrt;
  const T angle2 = w.squaredNorm();
  if (angle2 < T(1e-16)) return x + w.cross(x);
  const T angle = sqrt(angle2);
  const Vector3T<T> axis = w / angle;
  const T c = cos(angle);
  return c * x + sin(angle) * axis.cross(x) + (T(1) - c) * axis.dot(x) * axis;
}

template <typename T>
Vector3T<T> tilted(const Eigen::Vector3d& direction, const T& a, const T& b) {
  const TangentBasis basis = tangent_basis(direction);
  return (direction.cast<T>() + a * basis.a.cast<T>() + b * basis.b.cast<T>()).normalized();
}

/// Pixel of a point of the camera frame.
template <typename T>
Vector2T<T> projected(const Camera& c, const T* d, const Vector2T<T>& normalized) {
  const T& x = normalized.x();
  const T& y = normalized.y();
  const T k1 = c.k1 + d[4];
  const T k2 = c.k2 + d[5];
  const T p1 = c.p1 + d[6];
  const T p2 = c.p2 + d[7];
  const T k3 = c.k3 + d[8];
  const T r2 = x * x + y * y;
  const T radial = T(1) + r2 * (k1 + r2 * (k2 + r2 * k3));
  const T u = x * radial + T(2) * p1 * x * y + p2 * (r2 + T(2) * x * x);
  const T v = y * radial + p1 * (r2 + T(2) * y * y) + T(2) * p2 * x * y;
  return {(c.fx + d[0]) * u + c.cx + d[2], (c.fy + d[1]) * v + c.cy + d[3]};
}

/// A point of a pose's target frame; `d` is a shift and a turn in the source frame.
template <typename T>
Vector3T<T> posed(const RigidTransform& base, const T* d, const Vector3T<T>& x) {
  const Vector3T<T> moved_point =
      turned_by<T>({d[3], d[4], d[5]}, x) + Vector3T<T>(d[0], d[1], d[2]);
  const Eigen::Matrix3d rotation = base.rotation.toRotationMatrix();
  return rotation.cast<T>() * moved_point + base.translation.cast<T>();
}

/// A direction likewise.
template <typename T>
Vector3T<T> posed_direction(const RigidTransform& base, const T* d, const Vector3T<T>& x) {
  const Eigen::Matrix3d rotation = base.rotation.toRotationMatrix();
  return rotation.cast<T>() * turned_by<T>({d[3], d[4], d[5]}, x);
}

/// From the scan frame into the camera at an axis position; directions are not shifted.
template <typename T>
Vector3T<T> camera_from_scan(
    const Axis& base, const T* d, const T& position, const Vector3T<T>& x, bool is_direction) {
  using std::cos;
  using std::sin;
  const Eigen::Matrix3d back = base.scan_from_camera.rotation.toRotationMatrix().transpose();
  const Eigen::Vector3d& origin = base.scan_from_camera.translation;
  if (base.kind == AxisKind::kLinear) {
    if (is_direction) return back.cast<T>() * x;
    const Vector3T<T> shifted =
        x - origin.cast<T>() - position * tilted<T>(base.direction, d[0], d[1]);
    return back.cast<T>() * shifted;
  }
  // Inverse of Rz(position) of a pan, Rz(-position) of a turntable.
  const T angle = base.kind == AxisKind::kPan ? T(-position) : T(position);
  const T c = cos(angle);
  const T s = sin(angle);
  Vector3T<T> turned(c * x.x() - s * x.y(), s * x.x() + c * x.y(), x.z());
  if (!is_direction) turned -= Vector3T<T>(d[2], d[3], T(0));
  turned = turned_by<T>({-d[0], -d[1], T(0)}, turned);
  if (!is_direction) turned -= origin.cast<T>();
  return back.cast<T>() * turned;
}

/// LaserPlane::sheet_distance(). Without `bends` the sheet is flat whatever its bow says.
template <typename T>
T distance_off_sheet(const LaserPlane& base, const T* d, const Vector3T<T>& x, bool bends) {
  using std::tan;
  const Vector3T<T> normal = tilted<T>(base.normal, d[0], d[1]);
  const T distance = base.distance + d[2];
  T off = normal.dot(x) - distance;
  if (!bends) return off;
  const Vector2T<T> across = normal.template head<2>();
  Vector3T<T> origin = distance * normal;
  if (!(across.squaredNorm() < T(1e-4))) {
    origin = Vector3T<T>(across.x(), across.y(), T(0)) * (distance / across.squaredNorm());
  }
  const Vector3T<T> unit_z(T(0), T(0), T(1));
  Vector3T<T> axis = unit_z - normal.z() * normal;
  if (axis.norm() < T(1e-3)) {
    axis = Vector3T<T>(T(1), T(0), T(0)) - normal.x() * normal;
  }
  axis.normalize();
  const Vector3T<T> rho = x - origin;
  const Vector3T<T> in_plane = rho - normal.dot(rho) * normal;
  return off - tan(base.bow + d[3]) * (in_plane.norm() - in_plane.dot(axis));
}

}  // namespace facula
