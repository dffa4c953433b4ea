// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/reconstruct/register/pose_certainty.hpp>
#include <facula/reconstruct/register/undecided_directions.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace facula {
namespace {

using Basis = Eigen::Matrix<double, 6, Eigen::Dynamic>;
using Cell = std::array<long, 3>;

constexpr double kLeastSlope = 0.1;    // below, more than half of the pairs are outliers
constexpr double kMostLeverage = 0.9;  // of one cluster, which is left out in thought [1]

Cell cell_of(const Eigen::Vector3d& point, double edge) {
  return {std::lround(std::floor(point.x() / edge)),
          std::lround(std::floor(point.y() / edge)),
          std::lround(std::floor(point.z() / edge))};
}

/// What the pairs of one cell say of a twist (m, rad * radius) about the pivot.
struct Cluster {
  Vector6 score = Vector6::Zero();      ///< gradient
  Matrix6 curvature = Matrix6::Zero();  ///< its change by the twist
  Matrix6 stiffness = Matrix6::Zero();  ///< the same without a kernel
};

/// Counterparts are found anew as a scan moves, so points slide along each other's surfaces freely:
/// only the offset along the normal resists.
std::vector<Cluster> clusters_of(const std::vector<PointPair>& pairs,
                                 const PairSystem& system,
                                 const PairOptions& options,
                                 double edge) {
  Vector6 unit;
  unit << 1, 1, 1, Eigen::Vector3d::Constant(1 / system.radius);
  std::map<Cell, Cluster> cells;
  for (const PointPair& pair : pairs) {
    const RobustWeight robust = robust_weight(options.kernel, pair.residual / system.scale);
    const Eigen::Matrix<double, 3, 6> j =
        pose_jacobian(pair.point - system.pivot) * unit.asDiagonal();
    const Vector6 across = j.transpose() * pair.normal;
    const Matrix6 stiffness =
        pair.normal.dot(pair.weight * pair.normal) * across * across.transpose();
    Cluster& cluster = cells[cell_of(pair.point - pair.offset, edge)];
    cluster.score += robust.weight * (j.transpose() * (pair.weight * pair.offset));
    cluster.curvature += robust.slope * stiffness;
    cluster.stiffness += stiffness;
  }
  std::vector<Cluster> clusters;
  clusters.reserve(cells.size());
  for (const auto& [cell, cluster] : cells) clusters.push_back(cluster);
  return clusters;
}

/// L with L L' = the curvature of all clusters in the basis; no direction of it is taken for
/// flatter than kLeastSlope of its stiffness.
Eigen::MatrixXd root_of_curvature(const std::vector<Cluster>& clusters, const Basis& basis) {
  Matrix6 curvature = Matrix6::Zero();
  Matrix6 stiffness = Matrix6::Zero();
  for (const Cluster& cluster : clusters) {
    curvature += cluster.curvature;
    stiffness += cluster.stiffness;
  }
  const Eigen::MatrixXd root = (basis.transpose() * stiffness * basis).llt().matrixL();
  const auto lower = root.triangularView<Eigen::Lower>();
  const Eigen::MatrixXd half = lower.solve(basis.transpose() * curvature * basis);
  const Eigen::MatrixXd unit = lower.solve(half.transpose());
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver((unit + unit.transpose()) / 2);
  const Eigen::VectorXd slopes = solver.eigenvalues().cwiseMax(kLeastSlope);
  const Eigen::MatrixXd shaped =
      root * solver.eigenvectors() * slopes.asDiagonal() * solver.eigenvectors().transpose();
  return (shaped * root.transpose()).llt().matrixL();
}

/// How far the pose moves, in units in which the curvature is 1, when one cluster is left out: the
/// delete-one jackknife, whose squares do not fall short where single clusters carry the pose.
Eigen::VectorXd left_out(const Cluster& cluster, const Eigen::MatrixXd& root, const Basis& basis) {
  const auto lower = root.triangularView<Eigen::Lower>();
  const Eigen::VectorXd score = lower.solve(basis.transpose() * cluster.score);
  const Eigen::MatrixXd half = lower.solve(basis.transpose() * cluster.curvature * basis);
  Eigen::MatrixXd leverage = lower.solve(half.transpose());
  const double most = leverage.trace();
  if (most > kMostLeverage) leverage *= kMostLeverage / most;
  const auto k = leverage.rows();
  const Eigen::LLT<Eigen::MatrixXd> rest(Eigen::MatrixXd::Identity(k, k) - leverage);
  return rest.info() == Eigen::Success ? Eigen::VectorXd(rest.solve(score)) : score;
}

/// Covariance of a sum of the moves. As many of its directions are too small as too large when few
/// moves tell, and the small ones mislead: it is drawn to the mean variance as far as the scatter
/// of the moves asks for (Ledoit and Wolf 2004).
Eigen::MatrixXd shrunk_covariance(const std::vector<Eigen::VectorXd>& moves, Eigen::Index size) {
  const double n = static_cast<double>(moves.size());
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(size, size);
  for (const Eigen::VectorXd& move : moves) covariance += move * move.transpose();
  const Eigen::MatrixXd target =
      covariance.trace() / static_cast<double>(size) * Eigen::MatrixXd::Identity(size, size);
  double scatter = 0;
  for (const Eigen::VectorXd& move : moves) {
    scatter += (n * move * move.transpose() - covariance).squaredNorm();
  }
  const double apart = (covariance - target).squaredNorm();
  const bool few = moves.size() < 2 * static_cast<std::size_t>(size);  // their scatter says nothing
  const double drawn = few || !(apart > 0) ? 1 : std::min(1.0, scatter / (n * n) / apart);
  return drawn * target + (1 - drawn) * covariance;
}

/// Covariance of the decided motions, as twists in the basis.
Eigen::MatrixXd decided_covariance(const std::vector<Cluster>& clusters, const Basis& basis) {
  if (basis.cols() == 0) return {};
  const Eigen::MatrixXd root = root_of_curvature(clusters, basis);
  std::vector<Eigen::VectorXd> moves;
  moves.reserve(clusters.size());
  for (const Cluster& cluster : clusters) moves.push_back(left_out(cluster, root, basis));
  const auto upper = root.transpose().triangularView<Eigen::Upper>();
  const Eigen::MatrixXd half = upper.solve(shrunk_covariance(moves, basis.cols()));
  return upper.solve(half.transpose());
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
  const DecidedMotions motions = decided_motions(system);
  const Basis& b = motions.decided;
  const Basis& open = motions.undecided;
  const Eigen::MatrixXd inner = decided_covariance(clusters_of(pairs, system, options, cell), b);
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
