// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/calibrate/joint_model.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace facula {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// Distance off the sheet where the ray of `pixel` meets the board's plane [m].
double off_sheet(const Rig& rig,
                 const RigidTransform& camera_from_board,
                 std::size_t laser,
                 const Eigen::Vector2d& pixel) {
  const auto n = rig.camera.undistort(pixel);
  if (!n) return kNaN;
  const Eigen::Vector3d ray(n->x(), n->y(), 1);
  const Eigen::Vector3d normal = camera_from_board.rotation * Eigen::Vector3d::UnitZ();
  const double depth = normal.dot(camera_from_board.translation) / normal.dot(ray);
  if (!(depth > 0) || !std::isfinite(depth)) return kNaN;
  return rig.lasers[laser].sheet_distance(depth * ray);
}

}  // namespace

RigidTransform camera_from_board(const JointState& state, const JointSight& sight, std::size_t i) {
  const RigidTransform& pose = state.poses[sight.pose];
  if (!sight.placed) return pose;
  return state.rig.axis.scan_from_camera_at(state.positions[i]).inverse() * pose;
}

Eigen::Vector2d point_residual(const JointState& state,
                               const std::vector<JointSight>& sights,
                               std::size_t i,
                               std::size_t p) {
  const JointPoint& point = sights[i].points[p];
  const Eigen::Vector3d x =
      camera_from_board(state, sights[i], i) * (state.scales[sights[i].board] * point.on_board);
  if (!(x.z() > 0)) return {kNaN, kNaN};
  return state.rig.camera.project(x) - point.pixel;
}

LineResidual line_residual(const JointState& state,
                           const std::vector<JointSight>& sights,
                           std::size_t i,
                           std::size_t p) {
  const JointLinePoint& point = sights[i].lines[p];
  const RigidTransform pose = camera_from_board(state, sights[i], i);
  const auto off = [&](double step) {
    return off_sheet(state.rig, pose, point.laser, point.pixel + step * point.across);
  };
  return {off(0), std::max(std::abs(off(0.5) - off(-0.5)), 1e-12)};
}

}  // namespace facula
