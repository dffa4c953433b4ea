// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/calibrate/ceres_bridge.hpp>
#include <facula/acquire/core/random.hpp>

#include <array>
#include <cmath>
#include <functional>
#include <vector>

#include <gtest/gtest.h>

namespace facula {
namespace {

/// One view of a board with a point and a line pixel, all parameters off the state at the start.
struct World {
  JointState state;
  std::vector<JointSight> sights;
  std::array<double, 9> camera{};
  std::array<double, 4> laser{};
  std::array<double, 6> pose{};
  std::array<double, 1> scale{};
  std::array<double, 4> axis{};
  std::array<double, 1> position{};
  bool bends = false;

  World(AxisKind kind, bool placed, double bow) : bends(bow != 0) {
    Rig& rig = state.rig;
    rig.camera = {.width = 1280, .height = 960, .fx = 900, .fy = 910, .cx = 640, .cy = 470};
    rig.camera.k1 = -0.1;
    rig.camera.k2 = 0.05;
    rig.camera.p1 = 0.002;
    rig.camera.p2 = -0.003;
    rig.camera.k3 = 0.02;
    LaserPlane plane;
    plane.name = "red";
    plane.normal = Eigen::Vector3d(0.9, 0.1, 0.4).normalized();
    plane.distance = 0.12;
    plane.bow = bow;
    rig.lasers = {plane};
    rig.axis.kind = kind;
    rig.axis.direction = Eigen::Vector3d(0.9, 0.2, -0.1).normalized();
    rig.axis.scan_from_camera.rotation =
        Eigen::AngleAxisd(0.7, Eigen::Vector3d(0.5, -0.6, 0.3).normalized());
    rig.axis.scan_from_camera.translation = {0.02, 0.03, -0.01};
    JointSight sight;
    sight.placed = placed;
    const RigidTransform camera_from_board{
        Eigen::Quaterniond(Eigen::AngleAxisd(0.6, Eigen::Vector3d(1, 0.5, 0.2).normalized())),
        Eigen::Vector3d(0.02, -0.03, 0.4)};
    state.positions = {0.3};
    state.scales = {1.01};
    state.poses = {placed ? rig.axis.scan_from_camera_at(0.3) * camera_from_board
                          : camera_from_board};
    sight.points = {{{0.05, 0.04, 0}, {700, 400}}};
    sight.lines = {{.laser = 0, .pixel = {720, 380}, .sigma = 0.1}};
    sights = {sight};
    Random random(7);
    const auto stir = [&](auto& values, double size) {
      for (double& v : values) v = size * random.normal();
    };
    stir(camera, 1e-2);
    stir(laser, 1e-2);
    stir(pose, 2e-2);
    stir(scale, 1e-2);
    stir(axis, 1e-2);
    stir(position, 1e-2);
  }

  JointViewPose view() const {
    return joint_view_pose(state, sights, 0, {pose.data(), axis.data(), position.data()});
  }
};

/// Residuals at the parameters of the world; derivatives of one block too when asked for.
using Evaluate = std::function<Eigen::VectorXd(double** jacobians)>;

/// Every derivative against central differences.
void expect_derivatives(const Evaluate& evaluate,
                        const std::vector<std::pair<double*, int>>& blocks) {
  const Eigen::Index residuals = evaluate(nullptr).size();
  std::vector<std::vector<double>> found;
  std::vector<double*> places;
  for (const auto& block : blocks) {
    found.emplace_back(static_cast<std::size_t>(block.second * residuals));
    places.push_back(found.back().data());
  }
  evaluate(places.data());
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    const auto [values, size] = blocks[b];
    for (int k = 0; k < size; ++k) {
      constexpr double kStep = 1e-6;
      const double kept = values[k];
      values[k] = kept + kStep;
      const Eigen::VectorXd above = evaluate(nullptr);
      values[k] = kept - kStep;
      const Eigen::VectorXd below = evaluate(nullptr);
      values[k] = kept;
      for (Eigen::Index r = 0; r < residuals; ++r) {
        const double wanted = (above[r] - below[r]) / (2 * kStep);
        EXPECT_NEAR(
            found[b][static_cast<std::size_t>(r * size + k)], wanted, 1e-5 * (std::abs(wanted) + 1))
            << "block " << b << " number " << k << " residual " << r;
      }
    }
  }
}

struct Case {
  AxisKind kind;
  bool placed;
  double bow;
};
const Case kCases[] = {{AxisKind::kNone, false, 0},
                       {AxisKind::kNone, false, 0.05},
                       {AxisKind::kPan, true, 0},
                       {AxisKind::kTurntable, true, 0.05},
                       {AxisKind::kLinear, true, 0}};

TEST(JointPointCost, HasTheDerivativesThatDifferencesShow) {
  for (const Case& c : kCases) {
    World w(c.kind, c.placed, c.bow);
    const auto evaluate = [&](double** jacobians) {
      const JointViewPose view = w.view();
      const JointPointCost cost(w.state, w.sights[0], w.sights[0].points[0], 0.1, view);
      const double* parameters[] = {
          w.camera.data(), w.pose.data(), w.scale.data(), w.axis.data(), w.position.data()};
      Eigen::VectorXd residuals(2);
      EXPECT_TRUE(cost.Evaluate(parameters, residuals.data(), jacobians));
      return residuals;
    };
    std::vector<std::pair<double*, int>> blocks{
        {w.camera.data(), 9}, {w.pose.data(), 6}, {w.scale.data(), 1}};
    if (c.placed) blocks.insert(blocks.end(), {{w.axis.data(), 4}, {w.position.data(), 1}});
    expect_derivatives(evaluate, blocks);
  }
}

TEST(JointLineCost, HasTheDerivativesThatDifferencesShow) {
  for (const Case& c : kCases) {
    World w(c.kind, c.placed, c.bow);
    const JointLinePoint& point = w.sights[0].lines[0];
    const Camera& camera = w.state.rig.camera;
    const Eigen::Vector2d normalized = *camera.undistort(point.pixel);
    const double unchanged[9] = {};
    const JointLineBase base{camera,
                             w.state.rig.lasers[0],
                             normalized,
                             joint_pixel(camera, unchanged, normalized).by_normalized.inverse(),
                             1e-3,
                             w.bends};
    const auto evaluate = [&](double** jacobians) {
      const JointViewPose view = w.view();
      const JointSheet sheet = joint_sheet(w.state.rig.lasers[0], w.laser.data());
      const JointLineCost cost(base, point.pixel, c.placed, view, sheet);
      const double* parameters[] = {
          w.camera.data(), w.laser.data(), w.pose.data(), w.axis.data(), w.position.data()};
      Eigen::VectorXd residuals(1);
      EXPECT_TRUE(cost.Evaluate(parameters, residuals.data(), jacobians));
      return residuals;
    };
    std::vector<std::pair<double*, int>> blocks{
        {w.camera.data(), 9}, {w.laser.data(), 4}, {w.pose.data(), 6}};
    if (c.placed) blocks.insert(blocks.end(), {{w.axis.data(), 4}, {w.position.data(), 1}});
    expect_derivatives(evaluate, blocks);
  }
}

/// At no change the costs are the residuals of the model, which knows nothing of derivatives.
TEST(JointCosts, AreTheModelsResidualsAtTheStart) {
  for (const Case& c : kCases) {
    World w(c.kind, c.placed, c.bow);
    w.camera.fill(0);
    w.laser.fill(0);
    w.pose.fill(0);
    w.scale.fill(0);
    w.axis.fill(0);
    w.position.fill(0);
    const JointViewPose view = w.view();
    const JointPointCost point(w.state, w.sights[0], w.sights[0].points[0], 0.1, view);
    const double* of_point[] = {
        w.camera.data(), w.pose.data(), w.scale.data(), w.axis.data(), w.position.data()};
    Eigen::Vector2d off;
    ASSERT_TRUE(point.Evaluate(of_point, off.data(), nullptr));
    EXPECT_LT((off * 0.1 - point_residual(w.state, w.sights, 0, 0)).norm(), 1e-9);

    const Camera& camera = w.state.rig.camera;
    const JointLinePoint& pixel = w.sights[0].lines[0];
    const Eigen::Vector2d normalized = *camera.undistort(pixel.pixel);
    const JointLineBase base{
        camera,
        w.state.rig.lasers[0],
        normalized,
        joint_pixel(camera, w.camera.data(), normalized).by_normalized.inverse(),
        1e-3,
        w.bends};
    const JointSheet sheet = joint_sheet(w.state.rig.lasers[0], w.laser.data());
    const JointLineCost line(base, pixel.pixel, c.placed, view, sheet);
    const double* of_line[] = {
        w.camera.data(), w.laser.data(), w.pose.data(), w.axis.data(), w.position.data()};
    double metres = 0;
    ASSERT_TRUE(line.Evaluate(of_line, &metres, nullptr));
    EXPECT_NEAR(metres * 1e-3, line_residual(w.state, w.sights, 0, 0).metres, 1e-12);
  }
}

}  // namespace
}  // namespace facula
