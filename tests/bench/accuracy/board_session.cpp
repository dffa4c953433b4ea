// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/tests/bench/accuracy/board_session.hpp>
#include <facula/tests/bench/accuracy/exact_stripe.hpp>

#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

namespace facula {
namespace {

double between(double low, double high, Random& random) {
  return low + (high - low) * random.uniform();
}

/// The board's middle lies on the first sheet at `depth`, in the upper, middle or lower third.
RigidTransform board_pose(const Rig& truth,
                          const BoardSession& session,
                          double depth,
                          Random& random) {
  const double height = truth.camera.height / truth.camera.fy * depth;
  const double y = between(-0.35, 0.35, random) * height;
  const LaserPlane& sheet = truth.lasers.front();
  const double x =
      (sheet.distance - sheet.normal.y() * y - sheet.normal.z() * depth) / sheet.normal.x();
  const double tilt = session.largest_tilt;
  RigidTransform pose;
  pose.rotation = Eigen::AngleAxisd(between(-tilt, tilt, random), Eigen::Vector3d::UnitX()) *
                  Eigen::AngleAxisd(between(-tilt, tilt, random), Eigen::Vector3d::UnitY()) *
                  Eigen::AngleAxisd(between(-tilt, tilt, random), Eigen::Vector3d::UnitZ());
  const Eigen::Vector3d middle =
      0.5 * session.board.point(static_cast<int>(session.board.size()) - 1);
  pose.translation = Eigen::Vector3d(x, y, depth) - pose.rotation * middle;
  return pose;
}

BoardView points_of(const Rig& truth,
                    const BoardSession& session,
                    const RigidTransform& pose,
                    Random& random) {
  BoardView view;
  view.image_width = truth.camera.width;
  view.image_height = truth.camera.height;
  for (int id = 0; id < static_cast<int>(session.board.size()); ++id) {
    const Eigen::Vector3d x = pose * session.board.point(id);
    if (!(x.z() > 0)) continue;
    const Eigen::Vector2d pixel = truth.camera.project(x);
    if (pixel.x() < 2 || pixel.y() < 2 || pixel.x() > truth.camera.width - 3 ||
        pixel.y() > truth.camera.height - 3) {
      continue;
    }
    view.ids.push_back(id);
    view.pixels.emplace_back(pixel.x() + session.noise * random.normal(),
                             pixel.y() + session.noise * random.normal());
  }
  return view;
}

LaserLineView line_of(const Rig& truth,
                      const BoardSession& session,
                      const RigidTransform& pose,
                      std::size_t laser,
                      Random& random) {
  LaserLineView line;
  line.laser = laser;
  const Eigen::Vector3d normal = pose.rotation * Eigen::Vector3d::UnitZ();
  const SurfaceHit surface = plane_surface(normal, normal.dot(pose.translation));
  const RigidTransform board_from_camera = pose.inverse();
  const Eigen::Vector3d last = session.board.point(static_cast<int>(session.board.size()) - 1);
  for (int row = 0; row < truth.camera.height; row += 2) {
    const auto column = exact_position(truth, laser, surface, row);
    if (!column) continue;
    const auto ray = truth.camera.undistort({*column, static_cast<double>(row)});
    const Eigen::Vector3d x = board_from_camera * *surface({ray->x(), ray->y(), 1});
    if (x.x() < 0 || x.y() < 0 || x.x() > last.x() || x.y() > last.y()) continue;
    line.pixels.emplace_back(*column + session.noise * random.normal(), row);
    line.sigmas.push_back(session.noise);
  }
  if (line.pixels.size() < 20) line.failure = "fewer than 20 places show the line";
  return line;
}

}  // namespace

CalibrationSet record_session(const Rig& truth, const BoardSession& session, Random& random) {
  CalibrationSet set;
  set.boards = {session.board};
  set.stripe_direction = truth.stripe_direction;
  for (const LaserPlane& laser : truth.lasers) set.lasers.push_back(laser.name);
  for (int i = 0; i < session.views; ++i) {
    const double share = (i + 0.5) / session.views;
    const double depth = session.nearest * std::pow(session.farthest / session.nearest, share);
    const RigidTransform pose = board_pose(truth, session, depth, random);
    JointView view;
    view.points = points_of(truth, session, pose, random);
    view.points.name = "view " + std::to_string(i + 1);
    for (std::size_t laser = 0; laser < truth.lasers.size(); ++laser) {
      LaserLineView line = line_of(truth, session, pose, laser, random);
      if (line.failure.empty()) view.lines.push_back(std::move(line));
    }
    set.views.push_back(std::move(view));
  }
  return set;
}

}  // namespace facula
