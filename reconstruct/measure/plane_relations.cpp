// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/reconstruct/measure/plane_relations.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

namespace facula {
namespace {

constexpr double kUnknownWay = 3;  // sigmas below which an angle's direction is not known [1]

/// How a component of the normal along `way` answers, `sign` times.
PlaneAnswer tilt(const PlaneFit& fit, const Eigen::Vector3d& way, double sign = 1) {
  return {fit, sign * Eigen::Vector3d(fit.axis_u.dot(way), fit.axis_v.dot(way), 0)};
}

double own_variance(const PlaneAnswer& answer) {
  return answer.to.dot(answer.fit.covariance * answer.to);
}

/// Of errors of poses: what one plane and the other make of an error of the same scan adds up
/// before it is squared. A plane that knows of none has none.
double pose_variance(const PlaneAnswer& a, const PlaneAnswer& b) {
  const Eigen::Index parts = std::max(a.fit.pose_response.cols(), b.fit.pose_response.cols());
  Eigen::RowVectorXd moved = Eigen::RowVectorXd::Zero(parts);
  for (const PlaneAnswer* answer : {&a, &b}) {
    const auto& response = answer->fit.pose_response;
    moved.head(response.cols()) += answer->to.transpose() * response;
  }
  return moved.squaredNorm();
}

/// The unit vector at right angles to `from` that leads to `to`; any one where both are parallel.
Eigen::Vector3d way_to(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  const Eigen::Vector3d way = to - from.dot(to) * from;
  return way.norm() > 1e-12 ? Eigen::Vector3d(way.normalized()) : from.unitOrthogonal();
}

}  // namespace

double joint_variance(const PlaneAnswer& a, const PlaneAnswer& b, const RelationOptions& options) {
  const double shared = a.to.dot(a.fit.range_response) + b.to.dot(b.fit.range_response);
  return own_variance(a) + own_variance(b) + pose_variance(a, b) +
         std::pow(options.shared_range_sigma * shared, 2);
}

void RelationOptions::check() const {
  require(shared_range_sigma >= 0 && std::isfinite(shared_range_sigma),
          "shared_range_sigma is ",
          shared_range_sigma,
          " m; give a length of 0 or more");
}

Measured measured_angle(const PlaneFit& a, const PlaneFit& b, const RelationOptions& options) {
  options.check();
  // Both normals on one side; b's turns away from a's along `open`, a's towards b's along `near`.
  const double side = a.plane.normal.dot(b.plane.normal) < 0 ? -1 : 1;
  const Eigen::Vector3d nb = side * b.plane.normal;
  const Eigen::Vector3d near = way_to(a.plane.normal, nb);
  const Eigen::Vector3d across = a.plane.normal.cross(near).normalized();
  const Eigen::Vector3d open = across.cross(nb);
  Measured angle{angle_between(a.plane, b.plane), 0};
  double variance = joint_variance(tilt(a, near, -1), tilt(b, open, side), options);
  if (angle.value < kUnknownWay * std::sqrt(variance)) {
    variance += joint_variance(tilt(a, across, -1), tilt(b, across, side), options);
  }
  angle.sigma = std::sqrt(variance);
  return angle;
}

Measured measured_corner(const PlaneFit& a, const PlaneFit& b, const RelationOptions& options) {
  Measured corner = measured_angle(a, b, options);
  if (a.plane.normal.dot(b.plane.normal) > 0) corner.value = std::numbers::pi - corner.value;
  return corner;
}

Measured measured_distance(const PlaneFit& a, const PlaneFit& b, const RelationOptions& options) {
  options.check();
  const Eigen::Vector3d d = b.centroid - a.centroid;
  const PlaneAnswer of_a{a, {d.dot(a.axis_u), d.dot(a.axis_v), -1}};
  const PlaneAnswer of_b{b, {0, 0, a.plane.normal.dot(b.plane.normal)}};
  return {distance_between(a, b), std::sqrt(joint_variance(of_a, of_b, options))};
}

Measured measured_angle_to(const PlaneFit& fit,
                           const Eigen::Vector3d& direction,
                           const RelationOptions& options) {
  require(direction.allFinite() && direction.norm() > 0,
          "expected a direction, got (",
          direction.x(),
          ", ",
          direction.y(),
          ", ",
          direction.z(),
          "); give a vector of a length above 0");
  PlaneFit exact;
  exact.plane.normal = direction.normalized();
  return measured_angle(fit, exact, options);
}

}  // namespace facula
