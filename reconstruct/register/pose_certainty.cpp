// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/reconstruct/register/pose_certainty.hpp>
#include <facula/reconstruct/register/undecided_directions.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include <Eigen/Cholesky>

namespace facula {
namespace {

using Basis = Eigen::Matrix<double, 6, Eigen::Dynamic>;
using Cell = std::array<long, 3>;

constexpr double kLeastSlope = 0.1;  // below, more than half of the pairs are outliers

Cell cell_of(const Eigen::Vector3d& point, double edge) {
  return {std::lround(std::floor(point.x() / edge)),
          std::lround(std::floor(point.y() / edge)),
          std::lround(std::floor(point.z() / edge))};
}

/// The two halves of the sandwich, for twists (m, rad * radius) about the pivot.
struct Sandwich {
  Matrix6 hessian = Matrix6::Zero();
  Matrix6 spread = Matrix6::Zero();  ///< of the gradient
  double clusters = 0;
};

Sandwich sandwich(const std::vector<PointPair>& pairs,
                  const PairSystem& system,
                  const PairOptions& options,
                  double edge) {
  Vector6 unit;
  unit << 1, 1, 1, Eigen::Vector3d::Constant(1 / system.radius);
  Sandwich halves;
  double slope = 0;
  std::map<Cell, Vector6> scores;
  for (const PointPair& pair : pairs) {
    const RobustWeight robust = robust_weight(options.kernel, pair.residual / system.scale);
    const Eigen::Matrix<double, 3, 6> j =
        pose_jacobian(pair.point - system.pivot) * unit.asDiagonal();
    const Eigen::Matrix<double, 3, 6> wj = pair.weight * j;
    halves.hessian += j.transpose() * wj;
    slope += robust.slope;
    const Cell cell = cell_of(pair.point - pair.offset, edge);
    scores.try_emplace(cell, Vector6::Zero()).first->second +=
        robust.weight * (wj.transpose() * pair.offset);
  }
  slope = std::max(slope / static_cast<double>(pairs.size()), kLeastSlope);
  halves.hessian *= slope;
  for (const auto& [cell, score] : scores) halves.spread += score * score.transpose();
  halves.clusters = static_cast<double>(scores.size());
  return halves;
}

/// Turns a twist (m, rad * radius) about the pivot into one (m, rad) about the frame's origin.
Matrix6 to_origin(const PairSystem& system) {
  Matrix6 map = about(-system.pivot);
  map.rightCols<3>() /= system.radius;
  return map;
}

Matrix6 symmetric(const Matrix6& m) {
  return (m + m.transpose()) / 2;
}

}  // namespace

PoseCertainty pose_certainty(const std::vector<PointPair>& pairs,
                             const PairSystem& system,
                             const PairOptions& options,
                             double cell) {
  const Sandwich halves = sandwich(pairs, system, options, cell);
  const DecidedMotions motions = decided_motions(system);
  const Basis& b = motions.decided;
  const Basis& open = motions.undecided;
  const double freedom = halves.clusters > 12 ? halves.clusters / (halves.clusters - 6) : 2;
  const Eigen::MatrixXd h = b.transpose() * halves.hessian * b;
  const Eigen::MatrixXd inverse = h.ldlt().solve(Eigen::MatrixXd::Identity(b.cols(), b.cols()));
  const Eigen::MatrixXd inner = freedom * inverse * (b.transpose() * halves.spread * b) * inverse;
  const Eigen::MatrixXd inner_information =
      inner.ldlt().solve(Eigen::MatrixXd::Identity(b.cols(), b.cols()));
  const double size2 = system.radius * system.radius;
  const Matrix6 map = to_origin(system);
  const Matrix6 back = map.inverse();
  PoseCertainty certainty;
  certainty.covariance = symmetric(
      map * (b * inner * b.transpose() + size2 * open * open.transpose()) * map.transpose());
  certainty.information =
      symmetric(back.transpose() * b * inner_information * b.transpose() * back);
  for (Eigen::Index c = 0; c < open.cols(); ++c) {
    const Vector6 twist = open.col(c);
    certainty.undecided.push_back(
        {twist, std::numeric_limits<double>::infinity(), motion_in_words(twist, system)});
  }
  return certainty;
}

}  // namespace facula
