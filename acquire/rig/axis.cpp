// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/rig/axis.hpp>

#include <cmath>

namespace facula {
namespace {

RigidTransform turned_about_z(double angle) {
  RigidTransform turn;
  turn.rotation = Eigen::Quaterniond(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()));
  return turn;
}

}  // namespace

RigidTransform Axis::scan_from_camera_at(double position) const {
  switch (kind) {
    case AxisKind::kPan:
      return turned_about_z(position) * scan_from_camera;
    case AxisKind::kTurntable:
      return turned_about_z(-position) * scan_from_camera;
    case AxisKind::kLinear:
      return {scan_from_camera.rotation, scan_from_camera.translation + position * direction};
    case AxisKind::kNone:
      break;
  }
  return scan_from_camera;
}

void Axis::check() const {
  require(scan_from_camera.translation.allFinite() && scan_from_camera.translation.norm() < 1e4,
          "axis translation_mm: expected finite lengths, got ",
          scan_from_camera.translation.transpose() * 1000);
  require(direction.allFinite() && std::abs(direction.norm() - 1) < 1e-3,
          "axis direction: expected a vector of length 1, got length ",
          direction.norm());
}

std::string to_string(AxisKind kind) {
  switch (kind) {
    case AxisKind::kPan:
      return "pan";
    case AxisKind::kTurntable:
      return "turntable";
    case AxisKind::kLinear:
      return "linear";
    case AxisKind::kNone:
      break;
  }
  return "none";
}

}  // namespace facula
