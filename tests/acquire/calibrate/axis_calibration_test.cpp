// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/calibrate/axis_calibration.hpp>
#include <facula/acquire/core/random.hpp>
#include <facula/acquire/rig/rig_file.hpp>
#include <facula/tests/support/matchers.hpp>
#include <facula/tests/support/real_data.hpp>

#include <cmath>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace facula {
namespace {

constexpr double kDegree = M_PI / 180;

Axis shipped_axis(const char* name) {
  return read_rig(shipped_data("rigs") / name).axis;
}

Axis linear_stage() {
  Axis axis;
  axis.kind = AxisKind::kLinear;
  axis.direction = Eigen::Vector3d(0.9, 0.3, -0.2).normalized();
  return axis;
}

RigidTransform small_pose(Random& random, double distance, double turn) {
  Eigen::Matrix<double, 6, 1> twist;
  for (int k = 0; k < 3; ++k) twist[k] = distance * random.normal();
  for (int k = 3; k < 6; ++k) twist[k] = turn * random.normal();
  return exp_se3(twist);
}

/// Two placements of a board, seen at `count` positions; poses carry noise in the board's frame.
std::vector<AxisView> views_along(const Axis& axis, int count, double step, double noise) {
  Random random(7);
  std::vector<RigidTransform> boards(2);
  boards[0].rotation = Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitX());
  boards[0].translation = {-0.05, -0.06, 0};
  boards[1].rotation = Eigen::AngleAxisd(0.9 * M_PI, Eigen::Vector3d(1, 0.1, 0).normalized());
  boards[1].translation = {0.02, -0.08, 0.03};
  std::vector<AxisView> views;
  for (int i = 0; i < count; ++i) {
    AxisView v;
    v.name = "view " + std::to_string(i);
    v.placement = static_cast<std::size_t>(i % 2);
    v.position = step * i;
    v.camera_from_board = axis.scan_from_camera_at(v.position).inverse() * boards[v.placement] *
                          small_pose(random, noise, 3 * noise);
    views.push_back(v);
  }
  return views;
}

/// Angle and distance between the axis lines as the camera sees them.
struct LineError {
  double angle;
  double distance;
};
LineError line_error(const Axis& found, const Axis& truth) {
  const RigidTransform a = found.scan_from_camera.inverse();
  const RigidTransform b = truth.scan_from_camera.inverse();
  const Eigen::Vector3d za = a.rotation * Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d zb = b.rotation * Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d apart = a.translation - b.translation;
  return {std::atan2(za.cross(zb).norm(), za.dot(zb)), (apart - apart.dot(zb) * zb).norm()};
}

TEST(FitAxis, IsExactWithoutNoise) {
  for (const char* name : {"ciclop_turntable.toml", "head_fs1500.toml"}) {
    const Axis truth = shipped_axis(name);
    const AxisFit fit = fit_axis(truth.kind, views_along(truth, 9, 7 * kDegree, 0));
    const LineError error = line_error(fit.axis, truth);
    EXPECT_LT(error.angle, 1e-9) << name;
    EXPECT_LT(error.distance, 1e-9) << name;
    EXPECT_LT(fit.rms_distance, 1e-9) << name;
    EXPECT_NEAR(fit.gain, 1, 1e-9) << name;
    EXPECT_NEAR(fit.span, 8 * 7 * kDegree, 1e-12) << name;
    EXPECT_TRUE(fit.warnings.empty()) << name;
  }
  const Axis stage = linear_stage();
  const AxisFit fit = fit_axis(AxisKind::kLinear, views_along(stage, 6, 0.02, 0));
  EXPECT_LT((fit.axis.direction - stage.direction).norm(), 1e-9);
  EXPECT_LT(fit.rms_distance, 1e-9);
}

/// The scan frame that the header promises.
TEST(FitAxis, PutsATurntablesScanFrameOnTheBoardAndFacesTheCamera) {
  const Axis truth = shipped_axis("ciclop_turntable.toml");
  const AxisFit fit = fit_axis(truth.kind, views_along(truth, 9, 7 * kDegree, 0));
  EXPECT_NEAR(fit.scan_from_board[0].translation.z(), 0, 1e-9);
  EXPECT_NEAR(fit.axis.scan_from_camera.translation.y(), 0, 1e-9);
  EXPECT_NEAR(fit.axis.scan_from_camera.translation.x(), 0.29, 1e-9);
  EXPECT_NEAR(fit.axis.scan_from_camera.translation.z(), 0.12, 1e-9);
}

TEST(FitAxis, LeavesOutAFifthOfWrongPosesAndNamesThem) {
  for (const char* name : {"ciclop_turntable.toml", "head_fs1500.toml"}) {
    const Axis truth = shipped_axis(name);
    std::vector<AxisView> views = views_along(truth, 30, 6 * kDegree, 5e-5);
    Random random(3);
    for (std::size_t i = 0; i < views.size(); i += 5) {
      views[i].camera_from_board = views[i].camera_from_board * small_pose(random, 0.03, 0.4);
    }
    const AxisFit fit = fit_axis(truth.kind, views);
    for (std::size_t i = 0; i < views.size(); ++i) {
      EXPECT_EQ(fit.views[i].inlier, i % 5 != 0) << name << " view " << i;
    }
    const LineError error = line_error(fit.axis, truth);
    EXPECT_LT(error.angle, 0.02 * kDegree) << name;
    EXPECT_LT(error.distance, 0.1e-3) << name;
    EXPECT_EQ(fit.warnings.size(), 6U) << name;
    EXPECT_GT(fit.rms_distance, 0.01) << "the figure must hold the wrong views too";
  }
}

TEST(FitAxis, SaysWhatTheViewsCannotDecide) {
  const Axis truth = shipped_axis("ciclop_turntable.toml");
  const auto complaint = [&](std::vector<AxisView> views, AxisKind kind = AxisKind::kTurntable) {
    return error_of([&] { fit_axis(kind, views); });
  };
  const auto good = views_along(truth, 9, 7 * kDegree, 0);
  EXPECT_NE(complaint({good[0], good[1]}).find("at least 3 views"), std::string::npos);
  EXPECT_NE(complaint(views_along(truth, 9, 0, 0)).find("one position"), std::string::npos);
  EXPECT_NE(complaint(views_along(truth, 9, 0.2 * kDegree, 0)).find("span only"),
            std::string::npos);
  EXPECT_NE(complaint(views_along(truth, 9, 360 * kDegree, 0)).find("no two views"),
            std::string::npos);
  EXPECT_NE(complaint(good, AxisKind::kNone).find("kind"), std::string::npos);
  auto apart = good;
  for (std::size_t i = 0; i < apart.size(); ++i) apart[i].placement = i;
  EXPECT_NE(complaint(apart).find("one position"), std::string::npos);
  auto wrong_unit = good;
  for (AxisView& v : wrong_unit) v.position *= 1.3;
  EXPECT_NE(complaint(wrong_unit).find("0.769"), std::string::npos) << complaint(wrong_unit);
  auto shuffled = good;
  for (std::size_t i = 0; i < shuffled.size(); ++i) {
    shuffled[i].position = good[(i * 4) % shuffled.size()].position;
  }
  EXPECT_NE(complaint(shuffled).find("positions"), std::string::npos);
  auto broken = good;
  broken[3].position = std::nan("");
  EXPECT_NE(complaint(broken).find("view 3"), std::string::npos);
  EXPECT_NE(complaint(views_along(linear_stage(), 6, 1e-4, 0), AxisKind::kLinear).find("3 mm"),
            std::string::npos);
}

TEST(FitAxis, WarnsOfAGainNearOne) {
  const Axis truth = shipped_axis("head_fs1500.toml");
  std::vector<AxisView> views = views_along(truth, 12, 5 * kDegree, 0);
  for (AxisView& v : views) v.position /= 1.02;
  const AxisFit fit = fit_axis(truth.kind, views);
  EXPECT_NEAR(fit.gain, 1.02, 1e-3);
  ASSERT_FALSE(fit.warnings.empty());
  EXPECT_NE(fit.warnings[0].find("1.02"), std::string::npos);
}

}  // namespace
}  // namespace facula
