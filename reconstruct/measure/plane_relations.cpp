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

/// How a quantity answers the (a, b, h) of a plane at its centroid.
using Response = Eigen::Vector3d;

/// How a component of the normal along `way` answers.
Response tilt_response(const PlaneFit& fit, const Eigen::Vector3d& way) {
  return {fit.axis_u.dot(way), fit.axis_v.dot(way), 0};
}

double variance_of(const PlaneFit& fit, const Response& response) {
  return response.dot(fit.covariance * response);
}

/// Variance of a quantity that answers two planes, with the error their ranges share.
double joint_variance(const PlaneFit& a,
                      const Response& to_a,
                      const PlaneFit& b,
                      const Response& to_b,
                      const RelationOptions& options) {
  const double shared = to_a.dot(a.range_response) + to_b.dot(b.range_response);
  return variance_of(a, to_a) + variance_of(b, to_b) +
         std::pow(options.shared_range_sigma * shared, 2);
}

/// The unit vector at right angles to `from` that leads to `to`; any one where both are parallel.
Eigen::Vector3d way_to(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  const Eigen::Vector3d way = to - from.dot(to) * from;
  return way.norm() > 1e-12 ? Eigen::Vector3d(way.normalized()) : from.unitOrthogonal();
}

}  // namespace

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
  double variance =
      joint_variance(a, tilt_response(a, -near), b, side * tilt_response(b, open), options);
  if (angle.value < kUnknownWay * std::sqrt(variance)) {
    variance +=
        joint_variance(a, tilt_response(a, -across), b, side * tilt_response(b, across), options);
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
  const Response to_a(d.dot(a.axis_u), d.dot(a.axis_v), -1);
  const Response to_b(0, 0, a.plane.normal.dot(b.plane.normal));
  return {distance_between(a, b), std::sqrt(joint_variance(a, to_a, b, to_b, options))};
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
