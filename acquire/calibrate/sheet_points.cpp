// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/calibrate/sheet_fit.hpp>
#include <facula/acquire/core/error.hpp>

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

namespace facula {
namespace {

/// Ray t r meets the plane m . x = e at t = e / m . r. A turn w of the board about its origin o and
/// a shift s along m change that by dt = (s - (w x m) . (x - o)) / m . r.
std::optional<SheetPoint> sheet_point(const Camera& camera,
                                      const RigidTransform& pose,
                                      const LaserLineView& line,
                                      std::size_t i,
                                      double least_sigma) {
  const auto x = meet_board(camera, pose, line.pixels[i]);
  Eigen::Vector2d across = Eigen::Vector2d::UnitX();
  if (line.direction == StripeDirection::kPerColumn) across = Eigen::Vector2d::UnitY();
  constexpr double kStep = 0.01;  // [px]
  const auto ahead = meet_board(camera, pose, line.pixels[i] + kStep * across);
  const auto behind = meet_board(camera, pose, line.pixels[i] - kStep * across);
  if (!x || !ahead || !behind) return std::nullopt;
  SheetPoint point;
  point.x = *x;
  point.per_pixel = (*ahead - *behind) / (2 * kStep);
  point.sigma = std::hypot(line.sigmas[i], least_sigma);
  const Eigen::Matrix3d axes = pose.rotation.toRotationMatrix();
  const Eigen::Vector3d m = axes.col(2);
  const Eigen::Vector3d along_ray = *x / m.dot(*x);
  const Eigen::Vector3d from_origin = *x - pose.translation;
  for (int k = 0; k < 2; ++k) {
    point.per_pose.col(k) = -along_ray * Eigen::Vector3d(axes.col(k)).cross(m).dot(from_origin);
  }
  point.per_pose.col(2) = along_ray;
  return point;
}

}  // namespace

std::optional<Eigen::Vector3d> meet_board(const Camera& camera,
                                          const RigidTransform& camera_from_board,
                                          const Eigen::Vector2d& pixel) {
  const auto ray = camera.undistort(pixel);
  if (!ray) return std::nullopt;
  const Eigen::Vector3d direction(ray->x(), ray->y(), 1);
  const Eigen::Vector3d normal = camera_from_board.rotation * Eigen::Vector3d::UnitZ();
  const double approach = normal.dot(direction);
  if (std::abs(approach) < 1e-6 * direction.norm()) return std::nullopt;
  const double t = normal.dot(camera_from_board.translation) / approach;
  if (!(t > 0)) return std::nullopt;
  return t * direction;
}

std::vector<SheetView> sheet_views(const Camera& camera,
                                   const std::vector<BoardPose>& poses,
                                   const std::vector<LaserLineView>& lines,
                                   std::size_t laser,
                                   double least_sigma) {
  std::vector<SheetView> views;
  for (const LaserLineView& line : lines) {
    if (line.laser != laser || !line.failure.empty()) continue;
    require(line.view < poses.size(),
            "a laser line belongs to view ",
            line.view,
            ", but there are ",
            poses.size(),
            " poses");
    require(line.pixels.size() == line.sigmas.size(),
            "the laser line of view ",
            line.view,
            " holds ",
            line.pixels.size(),
            " pixels and ",
            line.sigmas.size(),
            " sigmas; expected one each");
    const BoardPose& pose = poses[line.view];
    SheetView view{line.view, pose.plane_covariance, {}};
    for (std::size_t i = 0; i < line.pixels.size(); ++i) {
      const auto point = sheet_point(camera, pose.camera_from_board, line, i, least_sigma);
      if (point) view.points.push_back(*point);
    }
    if (!view.points.empty()) views.push_back(std::move(view));
  }
  return views;
}

PlaneStart plane_through(const std::vector<SheetView>& views) {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  double count = 0;
  for (const auto& view : views) {
    for (const auto& p : view.points) centre += p.x;
    count += static_cast<double>(view.points.size());
  }
  centre /= count;
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const auto& view : views) {
    for (const auto& p : view.points)
      scatter += (p.x - centre) * (p.x - centre).transpose() / count;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(scatter);
  PlaneStart start;
  start.plane.normal = solver.eigenvectors().col(0);
  if (start.plane.normal.dot(centre) < 0) start.plane.normal = -start.plane.normal;
  start.plane.distance = start.plane.normal.dot(centre);
  start.breadth = std::sqrt(std::max(0.0, solver.eigenvalues()[1]));
  start.length = std::sqrt(std::max(0.0, solver.eigenvalues()[2]));
  return start;
}

}  // namespace facula
