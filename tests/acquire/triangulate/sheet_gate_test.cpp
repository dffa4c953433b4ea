// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/triangulate/sheet_gate.hpp>
#include <facula/acquire/triangulate/triangulate.hpp>
#include <facula/tests/support/matchers.hpp>

#include <cmath>

#include <gtest/gtest.h>

namespace facula {
namespace {

/// A pan head with a leaning sheet, and a volume between two depths.
Capture head(double min_depth, double max_depth) {
  Capture capture;
  capture.rig.camera = {.width = 320, .height = 240, .fx = 300, .fy = 300, .cx = 160, .cy = 120};
  LaserPlane laser;
  laser.normal = Eigen::Vector3d(std::cos(0.2), 0.1, std::sin(0.2)).normalized();
  laser.distance = 0.08;
  capture.rig.lasers = {laser};
  capture.rig.axis.kind = AxisKind::kPan;
  capture.volume.min_depth = min_depth;
  capture.volume.max_depth = max_depth;
  return capture;
}

/// Whether a column is allowed, asked pixel by pixel.
bool allowed(const Capture& capture, int row, int column) {
  const auto point = triangulate(capture.rig, 0, Eigen::Vector2d(column, row), 0);
  return point && capture.volume.contains(capture.rig.axis.scan_from_camera * point->x_in_camera,
                                          point->x_in_camera.z());
}

void expect_hull_of_allowed(const Capture& capture, const ColumnGate& gate) {
  for (int r = 0; r < 240; ++r) {
    int first = 320;
    int end = 0;
    for (int c = 0; c < 320; ++c) {
      if (!allowed(capture, r, c)) continue;
      first = std::min(first, c);
      end = c + 1;
    }
    const auto i = static_cast<std::size_t>(r);
    if (end == 0) {
      EXPECT_GE(gate.first[i], gate.end[i]) << r;
      continue;
    }
    EXPECT_EQ(gate.first[i], first) << r;
    EXPECT_EQ(gate.end[i], end) << r;
  }
}

TEST(SheetGate, AllowsExactlyTheColumnsWhereTheSheetIsWithinTheDepths) {
  const Capture capture = head(0.3, 0.8);
  expect_hull_of_allowed(capture, sheet_gate(capture, 0));
}

TEST(SheetGate, FindsAVolumeThinnerThanItsSteps) {
  const Capture capture = head(0.40, 0.42);
  expect_hull_of_allowed(capture, sheet_gate(capture, 0));
}

TEST(SheetGate, HoldsTheRadiusOfATurntable) {
  Capture capture = head(0.1, 5);
  capture.rig.axis.kind = AxisKind::kTurntable;
  capture.rig.axis.scan_from_camera.translation = {0, 0, -0.5};
  capture.volume.max_radius = 0.15;
  expect_hull_of_allowed(capture, sheet_gate(capture, 0));
}

TEST(SheetGate, LeavesAMarginAndStaysInTheImage) {
  const Capture capture = head(0.3, 0.8);
  const ColumnGate tight = sheet_gate(capture, 0);
  const ColumnGate wide = sheet_gate(capture, 5);
  for (std::size_t r = 0; r < tight.first.size(); ++r) {
    if (tight.first[r] >= tight.end[r]) continue;
    EXPECT_EQ(wide.first[r], std::max(0, tight.first[r] - 5));
    EXPECT_EQ(wide.end[r], std::min(320, tight.end[r] + 5));
  }
}

TEST(SheetGate, IsNoneWhereNothingIsBounded) {
  Capture capture = head(0.3, 0.8);
  capture.volume = {};
  EXPECT_TRUE(sheet_gate(capture).empty());
  capture = head(0.3, 0.8);
  capture.zero_line = ZeroLine{};
  EXPECT_TRUE(sheet_gate(capture).empty());
  // A linear axis moves the radius along: only depths last.
  capture = head(0.3, 0.8);
  capture.volume = {};
  capture.volume.max_radius = 0.1;
  capture.rig.axis.kind = AxisKind::kLinear;
  EXPECT_TRUE(sheet_gate(capture).empty());
}

}  // namespace
}  // namespace facula
