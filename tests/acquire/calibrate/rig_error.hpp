// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/rig/rig.hpp>
#include <facula/acquire/rig/rig_parameters.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

namespace facula {

/// The axis line of `truth` in the scan frame of `found`: where it meets z = 0 and its direction.
struct AxisLine {
  Eigen::Vector3d point;
  Eigen::Vector3d direction;
};
inline AxisLine true_axis_line(const Rig& found, const Rig& truth) {
  const RigidTransform found_from_true =
      found.axis.scan_from_camera * truth.axis.scan_from_camera.inverse();
  AxisLine line{found_from_true.translation, found_from_true.rotation * Eigen::Vector3d::UnitZ()};
  line.point -= line.direction * (line.point.z() / line.direction.z());
  return line;
}

/// The changes of the found rig's parameters that would lead to the truth, in the units of the
/// names; to first order.
inline Eigen::VectorXd parameter_errors(const Rig& found,
                                        const Rig& truth,
                                        const std::vector<std::string>& names) {
  std::map<std::string, double> error;
  const Camera& f = found.camera;
  const Camera& t = truth.camera;
  const double camera[] = {t.fx - f.fx,
                           t.fy - f.fy,
                           t.cx - f.cx,
                           t.cy - f.cy,
                           t.k1 - f.k1,
                           t.k2 - f.k2,
                           t.p1 - f.p1,
                           t.p2 - f.p2,
                           t.k3 - f.k3};
  const auto camera_names = camera_parameter_names();
  for (std::size_t k = 0; k < 9; ++k) error[camera_names[k]] = camera[k];
  for (std::size_t l = 0; l < found.lasers.size(); ++l) {
    const LaserPlane& plane = found.lasers[l];
    const LaserPlane& wanted = truth.lasers[l];
    const double sign = plane.normal.dot(wanted.normal) < 0 ? -1 : 1;
    const Eigen::Vector3d normal = sign * wanted.normal;
    const TangentBasis basis = tangent_basis(plane.normal);
    const std::string name = "laser." + plane.name + ".";
    error[name + "turn_a_rad"] = basis.a.dot(normal) / plane.normal.dot(normal);
    error[name + "turn_b_rad"] = basis.b.dot(normal) / plane.normal.dot(normal);
    error[name + "distance_mm"] = 1000 * (sign * wanted.distance - plane.distance);
    error[name + "bow_rad"] = sign * wanted.bow - plane.bow;
  }
  if (found.axis.is_revolute()) {
    const AxisLine line = true_axis_line(found, truth);
    const double sign = line.direction.z() < 0 ? -1 : 1;
    error["axis.turn_x_rad"] = sign * line.direction.y();
    error["axis.turn_y_rad"] = -sign * line.direction.x();
    error["axis.shift_x_mm"] = -1000 * line.point.x();
    error["axis.shift_y_mm"] = -1000 * line.point.y();
  } else if (found.axis.kind == AxisKind::kLinear) {
    const Eigen::Vector3d wanted =
        found.axis.scan_from_camera.rotation *
        (truth.axis.scan_from_camera.rotation.conjugate() * truth.axis.direction);
    const TangentBasis basis = tangent_basis(found.axis.direction);
    error["axis.direction_a_rad"] = basis.a.dot(wanted);
    error["axis.direction_b_rad"] = basis.b.dot(wanted);
  }
  Eigen::VectorXd errors(static_cast<Eigen::Index>(names.size()));
  for (std::size_t i = 0; i < names.size(); ++i) {
    errors[static_cast<Eigen::Index>(i)] = error.at(names[i]);
  }
  return errors;
}

/// How a calibrated rig compares with the truth.
struct RigError {
  double plane_angle = 0;     ///< largest over the sheets [deg]
  double plane_distance = 0;  ///< [mm]
  double axis_angle = 0;      ///< [deg]
  double axis_distance = 0;   ///< of the lines, at the scan frame's origin [mm]
  std::size_t inside = 0;     ///< parameters within 2 sigma [1]
  std::size_t parameters = 0;
  double squared = 0;  ///< normalized estimation error squared; as many as parameters in the mean
};

inline RigError rig_error(const Rig& found, const Rig& truth) {
  constexpr double kDegrees = 180 / M_PI;
  RigError e;
  const auto angle = [](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    return std::atan2(a.cross(b).norm(), std::abs(a.dot(b))) * kDegrees;
  };
  for (std::size_t l = 0; l < found.lasers.size(); ++l) {
    const LaserPlane& a = found.lasers[l];
    const LaserPlane& b = truth.lasers[l];
    const double sign = a.normal.dot(b.normal) < 0 ? -1 : 1;
    e.plane_angle = std::max(e.plane_angle, angle(a.normal, b.normal));
    e.plane_distance = std::max(e.plane_distance, 1000 * std::abs(a.distance - sign * b.distance));
  }
  if (found.axis.is_revolute()) {
    const AxisLine line = true_axis_line(found, truth);
    e.axis_angle = angle(line.direction, Eigen::Vector3d::UnitZ());
    e.axis_distance = 1000 * line.point.head<2>().norm();
  } else if (found.axis.kind == AxisKind::kLinear) {
    e.axis_angle = angle(found.axis.scan_from_camera.rotation.conjugate() * found.axis.direction,
                         truth.axis.scan_from_camera.rotation.conjugate() * truth.axis.direction);
  }
  if (!found.covariance) return e;
  const Eigen::VectorXd errors = parameter_errors(found, truth, found.covariance->parameters);
  const Eigen::MatrixXd& c = found.covariance->matrix;
  e.parameters = found.covariance->parameters.size();
  for (Eigen::Index i = 0; i < errors.size(); ++i) {
    e.inside += std::abs(errors[i]) <= 2 * std::sqrt(c(i, i)) ? 1 : 0;
  }
  const Eigen::VectorXd sigma = c.diagonal().cwiseSqrt();
  const Eigen::VectorXd unit = errors.cwiseQuotient(sigma);
  const Eigen::MatrixXd correlation =
      sigma.cwiseInverse().asDiagonal() * c * sigma.cwiseInverse().asDiagonal();
  e.squared = unit.dot(correlation.ldlt().solve(unit));
  return e;
}

}  // namespace facula
