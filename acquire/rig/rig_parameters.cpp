// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/nearest_name.hpp>
#include <facula/acquire/rig/rig_parameters.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

namespace facula {
namespace {

struct CameraParameter {
  const char* name;
  double Camera::*value;
};
constexpr std::array<CameraParameter, 9> kCameraParameters{{{"camera.fx_px", &Camera::fx},
                                                            {"camera.fy_px", &Camera::fy},
                                                            {"camera.cx_px", &Camera::cx},
                                                            {"camera.cy_px", &Camera::cy},
                                                            {"camera.k1", &Camera::k1},
                                                            {"camera.k2", &Camera::k2},
                                                            {"camera.p1", &Camera::p1},
                                                            {"camera.p2", &Camera::p2},
                                                            {"camera.k3", &Camera::k3}}};
constexpr std::array<const char*, 4> kLaserParameters{
    "turn_a_rad", "turn_b_rad", "distance_mm", "bow_rad"};
constexpr std::array<const char*, 4> kLineParameters{
    "axis.turn_x_rad", "axis.turn_y_rad", "axis.shift_x_mm", "axis.shift_y_mm"};
constexpr std::array<const char*, 2> kDirectionParameters{"axis.direction_a_rad",
                                                          "axis.direction_b_rad"};

std::string laser_parameter_name(const LaserPlane& laser, std::size_t k) {
  return "laser." + laser.name + "." + kLaserParameters[k];
}

void tilt(Eigen::Vector3d& direction, const Eigen::Vector2d& turn) {
  const TangentBasis basis = tangent_basis(direction);
  direction = (direction + turn.x() * basis.a + turn.y() * basis.b).normalized();
}

/// Where each parameter's change is collected before the rig is moved once.
struct RigDelta {
  Camera camera;                       ///< used for its nine numbers only
  std::vector<Eigen::Vector4d> laser;  ///< turn a, turn b [rad], distance [m], bow [rad]
  Eigen::Vector4d line = Eigen::Vector4d::Zero();       ///< turn x, y [rad], shift x, y [m]
  Eigen::Vector2d direction = Eigen::Vector2d::Zero();  ///< [rad]
};

/// The place of a parameter in the delta and the factor from the name's unit to it.
struct Slot {
  double* value = nullptr;
  double factor = 1;
};

Slot find_slot(const Rig& rig, const std::string& name, RigDelta& delta) {
  const double factor = name.ends_with("_mm") ? 1e-3 : 1;
  for (const CameraParameter& p : kCameraParameters) {
    if (name == p.name) return {&(delta.camera.*p.value), factor};
  }
  for (std::size_t l = 0; l < rig.lasers.size(); ++l) {
    for (std::size_t k = 0; k < kLaserParameters.size(); ++k) {
      if (name == laser_parameter_name(rig.lasers[l], k)) {
        return {&delta.laser[l][static_cast<Eigen::Index>(k)], factor};
      }
    }
  }
  for (std::size_t k = 0; rig.axis.is_revolute() && k < kLineParameters.size(); ++k) {
    if (name == kLineParameters[k]) return {&delta.line[static_cast<Eigen::Index>(k)], factor};
  }
  for (std::size_t k = 0; rig.axis.kind == AxisKind::kLinear && k < 2; ++k) {
    if (name == kDirectionParameters[k]) {
      return {&delta.direction[static_cast<Eigen::Index>(k)], factor};
    }
  }
  return {};
}

Slot slot_of(const Rig& rig, const std::string& name, RigDelta& delta) {
  delta.laser.resize(rig.lasers.size(), Eigen::Vector4d::Zero());
  const Slot slot = find_slot(rig, name, delta);
  if (slot.value == nullptr) {
    const std::string near = nearest_name(name, rig_parameter_names(rig));
    fail("rig '",
         rig.name,
         "' has no parameter '",
         name,
         near.empty() ? "'" : "'; did you mean '" + near + "'?");
  }
  return slot;
}

}  // namespace

std::vector<std::string> camera_parameter_names() {
  std::vector<std::string> names;
  names.reserve(kCameraParameters.size());
  for (const CameraParameter& p : kCameraParameters) names.emplace_back(p.name);
  return names;
}

std::vector<std::string> rig_parameter_names(const Rig& rig) {
  std::vector<std::string> names = camera_parameter_names();
  for (const LaserPlane& laser : rig.lasers) {
    for (std::size_t k = 0; k < kLaserParameters.size(); ++k) {
      names.push_back(laser_parameter_name(laser, k));
    }
  }
  if (rig.axis.is_revolute()) {
    names.insert(names.end(), kLineParameters.begin(), kLineParameters.end());
  }
  if (rig.axis.kind == AxisKind::kLinear) {
    names.insert(names.end(), kDirectionParameters.begin(), kDirectionParameters.end());
  }
  return names;
}

TangentBasis tangent_basis(const Eigen::Vector3d& direction) {
  Eigen::Index least = 0;
  direction.cwiseAbs().minCoeff(&least);
  TangentBasis basis;
  basis.a = direction.cross(Eigen::Vector3d::Unit(least)).normalized();
  basis.b = direction.cross(basis.a);
  return basis;
}

Rig moved(const Rig& rig, const std::vector<std::string>& names, const Eigen::VectorXd& deltas) {
  require(static_cast<Eigen::Index>(names.size()) == deltas.size(),
          "expected one change per parameter, got ",
          deltas.size(),
          " for ",
          names.size());
  RigDelta delta;
  delta.laser.assign(rig.lasers.size(), Eigen::Vector4d::Zero());
  for (std::size_t i = 0; i < names.size(); ++i) {
    const Slot slot = slot_of(rig, names[i], delta);
    *slot.value += slot.factor * deltas[static_cast<Eigen::Index>(i)];
  }
  Rig result = rig;
  for (const CameraParameter& p : kCameraParameters) {
    result.camera.*p.value += delta.camera.*p.value;
  }
  for (std::size_t l = 0; l < rig.lasers.size(); ++l) {
    const Eigen::Vector4d& d = delta.laser[l];
    tilt(result.lasers[l].normal, d.head<2>());
    result.lasers[l].distance += d[2];
    result.lasers[l].bow += d[3];
  }
  Eigen::Matrix<double, 6, 1> twist;
  twist << 0, 0, 0, delta.line[0], delta.line[1], 0;
  RigidTransform shift = exp_se3(twist);
  shift.translation = {delta.line[2], delta.line[3], 0};
  result.axis.scan_from_camera = shift * rig.axis.scan_from_camera;
  tilt(result.axis.direction, delta.direction);
  return result;
}

double parameter_step(const Rig& rig, const std::string& name) {
  if (name.ends_with("_px")) return 1e-5 * rig.camera.fx;
  if (name.ends_with("_rad")) return 1e-5;
  if (name.starts_with("laser.") && name.ends_with("distance_mm")) {
    for (const LaserPlane& laser : rig.lasers) {
      if (name == laser_parameter_name(laser, 2)) return 1e-2 * std::abs(laser.distance);
    }
  }
  if (name.ends_with("_mm")) return 1e-2;
  return 1e-5;
}

void check_covariance(const Rig& rig, const RigCovariance& covariance) {
  RigDelta delta;
  std::set<std::string> seen;
  for (const std::string& name : covariance.parameters) {
    slot_of(rig, name, delta);
    require(seen.insert(name).second, "covariance: parameter '", name, "' is named twice");
  }
  const auto n = static_cast<Eigen::Index>(covariance.parameters.size());
  const Eigen::MatrixXd& m = covariance.matrix;
  require(n > 0 && m.rows() == n && m.cols() == n,
          "covariance: expected a matrix with one row and column for each of its ",
          n,
          " parameters, got ",
          m.rows(),
          " x ",
          m.cols());
  require(m.allFinite() && m.diagonal().minCoeff() >= 0,
          "covariance: expected finite numbers and variances of 0 or more on the diagonal");
  // Judged in units of the sigmas: the parameters' own units lie ten orders apart.
  const Eigen::VectorXd sigma = m.diagonal().cwiseSqrt().cwiseMax(1e-150);
  const Eigen::MatrixXd correlation =
      sigma.cwiseInverse().asDiagonal() * m * sigma.cwiseInverse().asDiagonal();
  const double skew = (correlation - correlation.transpose()).cwiseAbs().maxCoeff();
  require(skew < 1e-6, "covariance: expected a symmetric matrix, got halves that differ");
  const double least =
      Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(correlation, Eigen::EigenvaluesOnly)
          .eigenvalues()
          .minCoeff();
  require(least > -1e-6,
          "covariance: expected no negative variance in any direction (positive semidefinite), "
          "got an eigenvalue of ",
          least,
          " of the correlations; calibrate again rather than edit it by hand");
}

double parameter_sigma(const Rig& rig, const std::string& name) {
  if (!rig.covariance) return 0;
  const auto& names = rig.covariance->parameters;
  const auto it = std::find(names.begin(), names.end(), name);
  if (it == names.end()) return 0;
  const auto i = static_cast<Eigen::Index>(it - names.begin());
  return std::sqrt(rig.covariance->matrix(i, i));
}

}  // namespace facula
