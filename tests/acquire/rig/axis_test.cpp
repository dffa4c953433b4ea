// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/rig/axis.hpp>
#include <facula/tests/support/matchers.hpp>

#include <numbers>

#include <gtest/gtest.h>

namespace facula {
namespace {

constexpr double kQuarter = std::numbers::pi / 2;

Axis axis_of(AxisKind kind) {
  Axis axis;
  axis.kind = kind;
  axis.scan_from_camera.translation = Eigen::Vector3d(1, 0, 0.5);
  axis.direction = Eigen::Vector3d(0, 1, 0);
  return axis;
}

TEST(Axis, PanCarriesTheHeadAround) {
  const RigidTransform turned = axis_of(AxisKind::kPan).scan_from_camera_at(kQuarter);
  EXPECT_TRUE(is_near_point(turned.translation, {0, 1, 0.5}, 1e-12));
  EXPECT_TRUE(is_near_point(turned * Eigen::Vector3d(1, 0, 0), {0, 2, 0.5}, 1e-12));
}

TEST(Axis, TurntableUndoesTheTableTurn) {
  const Axis axis = axis_of(AxisKind::kTurntable);
  // A mark on the table at scan (0.3, 0, 0) has turned by a quarter when the camera sees it.
  const Eigen::Vector3d mark_in_room(0, 0.3, 0);
  const Eigen::Vector3d in_camera = axis.scan_from_camera.inverse() * mark_in_room;
  EXPECT_TRUE(is_near_point(axis.scan_from_camera_at(kQuarter) * in_camera, {0.3, 0, 0}, 1e-12));
}

TEST(Axis, LinearStageShiftsAlongItsDirection) {
  const RigidTransform moved = axis_of(AxisKind::kLinear).scan_from_camera_at(0.02);
  EXPECT_TRUE(is_near_point(moved.translation, {1, 0.02, 0.5}, 1e-12));
}

TEST(Axis, NothingMovesWithoutAnAxis) {
  const Axis axis = axis_of(AxisKind::kNone);
  EXPECT_TRUE(is_near_pose(axis.scan_from_camera_at(3), axis.scan_from_camera, 1e-12, 1e-12));
}

TEST(Axis, RefusesADirectionThatIsNotOfUnitLength) {
  Axis axis = axis_of(AxisKind::kLinear);
  axis.direction *= 2;
  EXPECT_NE(error_of([&] { axis.check(); }).find("direction"), std::string::npos);
}

}  // namespace
}  // namespace facula
