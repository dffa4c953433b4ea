// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/calibrate/joint_residuals.hpp>
#include <facula/acquire/calibrate/joint_view.hpp>

#include <array>

#include <ceres/jet.h>

namespace facula {
namespace {

template <int kFirst, int kCount, int kAll>
std::array<ceres::Jet<double, kAll>, kCount> variables(const double* values) {
  std::array<ceres::Jet<double, kAll>, kCount> jets;
  for (int k = 0; k < kCount; ++k) jets[k] = {values[k], kFirst + k};
  return jets;
}

}  // namespace

JointViewPose joint_view_pose(const JointState& state,
                              const std::vector<JointSight>& sights,
                              std::size_t i,
                              const JointViewChange& change) {
  using Jet = ceres::Jet<double, 11>;
  const JointSight& sight = sights[i];
  const RigidTransform& base = state.poses[sight.pose];
  const auto pose = variables<0, 6, 11>(change.pose);
  std::array<Vector3T<Jet>, 4> columns;
  for (int k = 0; k < 3; ++k) {
    const Vector3T<Jet> unit = Eigen::Vector3d::Unit(k).cast<Jet>();
    columns[k] = posed_direction<Jet>(base, pose.data(), unit);
  }
  columns[3] = posed<Jet>(base, pose.data(), Vector3T<Jet>::Zero());
  if (sight.placed) {
    const auto axis = variables<6, 4, 11>(change.axis);
    const Jet position = state.positions[i] + Jet(change.position[0], 10);
    for (int k = 0; k < 4; ++k) {
      columns[k] = camera_from_scan<Jet>(state.rig.axis, axis.data(), position, columns[k], k < 3);
    }
  }
  JointViewPose view;
  for (int k = 0; k < 4; ++k) {
    for (int r = 0; r < 3; ++r) {
      view.at(r, k) = columns[k][r].a;
      view.by.row(3 * k + r) = columns[k][r].v.transpose();
    }
  }
  return view;
}

JointSheet joint_sheet(const LaserPlane& plane, const double* change) {
  using Jet = ceres::Jet<double, 4>;
  const auto d = variables<0, 4, 4>(change);
  const Vector3T<Jet> normal = tilted<Jet>(plane.normal, d[0], d[1]);
  JointSheet sheet;
  for (int r = 0; r < 3; ++r) {
    sheet.at[r] = normal[r].a;
    sheet.by.row(r) = normal[r].v.transpose();
  }
  sheet.at[3] = plane.distance + change[2];
  sheet.by.row(3) = Eigen::RowVector4d::Unit(2);
  return sheet;
}

JointPixel joint_pixel(const Camera& c, const double* d, const Eigen::Vector2d& normalized) {
  const double x = normalized.x();
  const double y = normalized.y();
  const double fx = c.fx + d[0];
  const double fy = c.fy + d[1];
  const double k1 = c.k1 + d[4];
  const double k2 = c.k2 + d[5];
  const double p1 = c.p1 + d[6];
  const double p2 = c.p2 + d[7];
  const double k3 = c.k3 + d[8];
  const double r2 = x * x + y * y;
  const double radial = 1 + r2 * (k1 + r2 * (k2 + r2 * k3));
  const double slope = 2 * (k1 + r2 * (2 * k2 + r2 * 3 * k3));  // of radial by x, over x
  const double u = x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x);
  const double v = y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y;
  JointPixel pixel;
  pixel.at = {fx * u + c.cx + d[2], fy * v + c.cy + d[3]};
  const double mixed = x * y * slope + 2 * (p1 * x + p2 * y);
  pixel.by_normalized << fx * (radial + x * x * slope + 2 * p1 * y + 6 * p2 * x), fx * mixed,
      fy * mixed, fy * (radial + y * y * slope + 6 * p1 * y + 2 * p2 * x);
  const double r4 = r2 * r2;
  pixel.by_camera.row(0) << u, 0, 1, 0, fx * x * r2, fx * x * r4, fx * 2 * x * y,
      fx * (r2 + 2 * x * x), fx * x * r4 * r2;
  pixel.by_camera.row(1) << 0, v, 0, 1, fy * y * r2, fy * y * r4, fy * (r2 + 2 * y * y),
      fy * 2 * x * y, fy * y * r4 * r2;
  return pixel;
}

}  // namespace facula
