// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/rig/rig_parameters.hpp>
#include <facula/acquire/triangulate/calibration_sigma.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace facula {
namespace {

constexpr int kNodes = 31;  // along each side of the image: sigma is then good to 3 % (tested)

std::optional<Eigen::Vector3d> point_of(const Rig& rig,
                                        std::size_t laser,
                                        const Eigen::Vector2d& pixel) {
  const auto n = rig.camera.undistort(pixel);
  if (!n) return std::nullopt;
  return rig.lasers[laser].intersect({n->x(), n->y(), 1});
}

}  // namespace

CalibrationSigma::CalibrationSigma(const Rig& rig, std::size_t laser) : rig_(rig), laser_(laser) {
  if (!rig.covariance || rig.lasers.empty()) return;
  require(laser < rig.lasers.size(),
          "expected a laser below ",
          rig.lasers.size(),
          ", the number in the rig, got ",
          laser);
  const std::vector<std::string>& names = rig.covariance->parameters;
  covariance_ = rig.covariance->matrix;
  rig_.covariance.reset();
  for (const std::string& name : names) {
    step_.push_back(parameter_step(rig, name));
    for (const double sign : {1.0, -1.0}) {
      changed_.push_back(moved(rig_, {name}, Eigen::VectorXd::Constant(1, sign * step_.back())));
    }
  }
  spacing_ = Eigen::Vector2d(rig.camera.width - 1, rig.camera.height - 1) / (kNodes - 1);
  nodes_.reserve(static_cast<std::size_t>(kNodes) * kNodes);
  for (int v = 0; v < kNodes; ++v) {
    for (int u = 0; u < kNodes; ++u) {
      nodes_.push_back(node_at(spacing_.cwiseProduct(Eigen::Vector2d(u, v))));
    }
  }
}

CalibrationSigma::Node CalibrationSigma::node_at(const Eigen::Vector2d& pixel) const {
  Node none = Node::Constant(std::numeric_limits<double>::quiet_NaN());
  const auto x = point_of(rig_, laser_, pixel);
  if (!x) return none;
  const Eigen::Vector3d ray = rig_.axis.scan_from_camera.rotation * x->normalized();
  const auto n = static_cast<Eigen::Index>(step_.size());
  Eigen::VectorXd at_zero(n);  // along the ray, per unit of the parameter
  Eigen::VectorXd per_position = Eigen::VectorXd::Zero(n);  // the same per metre of a linear axis
  for (Eigen::Index p = 0; p < n; ++p) {
    const Rig& up = changed_[2 * static_cast<std::size_t>(p)];
    const Rig& down = changed_[2 * static_cast<std::size_t>(p) + 1];
    const auto x_up = point_of(up, laser_, pixel);
    const auto x_down = point_of(down, laser_, pixel);
    if (!x_up || !x_down) return none;
    const double span = 2 * step_[static_cast<std::size_t>(p)];
    at_zero[p] =
        ray.dot(up.axis.scan_from_camera * *x_up - down.axis.scan_from_camera * *x_down) / span;
    if (rig_.axis.kind == AxisKind::kLinear) {
      per_position[p] = ray.dot(up.axis.direction - down.axis.direction) / span;
    }
  }
  const Eigen::VectorXd c_zero = covariance_ * at_zero;
  const Node variance(at_zero.dot(c_zero),
                      2 * per_position.dot(c_zero),
                      per_position.dot(covariance_ * per_position));
  const double range2 = x->squaredNorm();
  return variance / (range2 * range2);
}

double CalibrationSigma::exact_variance(const Eigen::Vector2d& pixel, double position) const {
  if (!known()) return 0;
  const auto x = point_of(rig_, laser_, pixel);
  if (!x) return std::numeric_limits<double>::quiet_NaN();
  const double range2 = x->squaredNorm();
  return node_at(pixel).dot(Node(1, position, position * position)) * range2 * range2;
}

double CalibrationSigma::variance(const Eigen::Vector2d& pixel,
                                  double range,
                                  double position) const {
  if (!known()) return 0;
  const Eigen::Vector2d at =
      pixel.cwiseQuotient(spacing_).cwiseMax(0.0).cwiseMin(static_cast<double>(kNodes - 1));
  const int u = std::min(static_cast<int>(at.x()), kNodes - 2);
  const int v = std::min(static_cast<int>(at.y()), kNodes - 2);
  const double s = at.x() - u;
  const double t = at.y() - v;
  const auto node = [&](int i, int j) -> const Node& {
    return nodes_[static_cast<std::size_t>(v + j) * kNodes + static_cast<std::size_t>(u + i)];
  };
  Node between = (1 - t) * ((1 - s) * node(0, 0) + s * node(1, 0)) +
                 t * ((1 - s) * node(0, 1) + s * node(1, 1));
  if (!between.allFinite()) between = node_at(pixel);
  if (!between.allFinite()) return 0;  // no triangulated point lies there
  const double range2 = range * range;
  return std::max(0.0, between.dot(Node(1, position, position * position)) * range2 * range2);
}

}  // namespace facula
