// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/reconstruct/register/pose_graph.hpp>
#include <facula/reconstruct/register/pose_graph_residual.hpp>
#include <facula/reconstruct/register/twist.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numeric>

#include <Eigen/Eigenvalues>
#include <ceres/ceres.h>

namespace facula {
namespace {

using Poses = std::vector<RigidTransform>;

/// An edge whose residual is whitened: root^T root = information.
struct WhiteEdge {
  Matrix6 root;
  int rank = 0;
};

WhiteEdge whitened(const PoseEdge& edge, std::size_t number) {
  const Matrix6& information = edge.information;
  const auto names = [&] {
    std::ostringstream text;
    text << "edge " << number << " (scan " << edge.from << " to " << edge.to << ")";
    return text.str();
  };
  require(information.allFinite() && edge.to_from_from.translation.allFinite() &&
              edge.to_from_from.rotation.coeffs().allFinite(),
          names(),
          " holds numbers that are not finite; leave it out");
  // Rotations and translations differ in unit: compare pure numbers.
  Vector6 scale;
  for (int k = 0; k < 6; ++k) scale[k] = std::sqrt(std::max(information(k, k), 1e-300));
  const Matrix6 unit =
      scale.cwiseInverse().asDiagonal() * information * scale.cwiseInverse().asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Matrix6> solver((unit + unit.transpose()) / 2);
  require(solver.eigenvalues()[0] > -1e-6 && (unit - unit.transpose()).norm() < 1e-6,
          names(),
          " has an information that is not symmetric and positive; give a covariance's inverse");
  WhiteEdge white;
  const auto values = solver.eigenvalues().cwiseMax(0).eval();
  white.root = values.cwiseSqrt().asDiagonal() * solver.eigenvectors().transpose();
  white.root = white.root * scale.asDiagonal();
  white.rank = static_cast<int>((values.array() > 1e-12).count());
  return white;
}

/// The lowest scan that each scan is joined with over the edges that count.
std::vector<std::size_t> components_of(std::size_t scans,
                                       const std::vector<PoseEdge>& edges,
                                       const std::vector<double>& weights) {
  std::vector<std::size_t> lowest(scans);
  std::iota(lowest.begin(), lowest.end(), std::size_t{0});
  for (bool changed = true; changed;) {
    changed = false;
    for (std::size_t e = 0; e < edges.size(); ++e) {
      if (!(weights[e] > 0)) continue;
      const std::size_t low = std::min(lowest[edges[e].from], lowest[edges[e].to]);
      changed = changed || lowest[edges[e].from] != low || lowest[edges[e].to] != low;
      lowest[edges[e].from] = lowest[edges[e].to] = low;
    }
  }
  return lowest;
}

/// The graph, and its least squares for any weights of the edges.
class Graph {
 public:
  Graph(std::size_t scans, const std::vector<PoseEdge>& edges, const PoseGraphOptions& options)
      : scans_(scans), edges_(edges), options_(options) {
    for (std::size_t e = 0; e < edges.size(); ++e) white_.push_back(whitened(edges[e], e));
  }

  /// Moves the poses to the least squares over all edges of weight above 0.
  void solve(const std::vector<double>& weights, Poses& poses) const {
    std::vector<std::array<double, 6>> change(scans_, std::array<double, 6>{});
    const auto problem = build(weights, poses, change);
    if (problem->NumResidualBlocks() == 0) return;
    ceres::Solver::Options how;
    how.linear_solver_type =
        scans_ > 40 ? ceres::SPARSE_NORMAL_CHOLESKY : ceres::DENSE_NORMAL_CHOLESKY;
    how.max_num_iterations = options_.max_iterations;
    how.function_tolerance = 1e-12;
    how.parameter_tolerance = 1e-12;
    how.gradient_tolerance = 1e-14;
    how.initial_trust_region_radius = 1e8;  // nearly Gauss-Newton
    how.num_threads = 1;
    how.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(how, problem.get(), &summary);
    require(summary.IsSolutionUsable(),
            "the pose graph's least squares failed: ",
            summary.message,
            "; start from poses nearer to the truth");
    for (std::size_t i = 0; i < scans_; ++i) poses[i] = moved(poses[i], change[i]);
  }

  double chi2(std::size_t e, const Poses& poses) const {
    return (white_[e].root * twist(e, poses)).squaredNorm();
  }
  Vector6 twist(std::size_t e, const Poses& poses) const {
    const PoseEdge& edge = edges_[e];
    return log_se3(poses[edge.to].inverse() * poses[edge.from] * edge.to_from_from.inverse());
  }

  /// Covariances of all poses and redundancies of all edges kept, into the result.
  void find_covariance(const std::vector<double>& weights, PoseGraphResult& result) const;

  int rank(std::size_t e) const { return white_[e].rank; }

 private:
  /// Scans that keep their pose: one of each component, the anchor where it is.
  std::vector<bool> held(const std::vector<double>& weights) const {
    const auto component = components_of(scans_, edges_, weights);
    std::vector<bool> held(scans_);
    for (std::size_t i = 0; i < scans_; ++i) {
      held[i] =
          component[i] == component[options_.anchor] ? i == options_.anchor : component[i] == i;
    }
    return held;
  }

  std::unique_ptr<ceres::Problem> build(const std::vector<double>& weights,
                                        const Poses& poses,
                                        std::vector<std::array<double, 6>>& change) const {
    auto problem = std::make_unique<ceres::Problem>();
    for (std::size_t e = 0; e < edges_.size(); ++e) {
      if (!(weights[e] > 0)) continue;
      const PoseEdge& edge = edges_[e];
      problem->AddResidualBlock(pose_edge_cost(poses[edge.from],
                                               poses[edge.to],
                                               edge.to_from_from,
                                               std::sqrt(weights[e]) * white_[e].root),
                                nullptr,
                                change[edge.from].data(),
                                change[edge.to].data());
    }
    const std::vector<bool> stays = held(weights);
    for (std::size_t i = 0; i < scans_; ++i) {
      if (stays[i] && problem->HasParameterBlock(change[i].data())) {
        problem->SetParameterBlockConstant(change[i].data());
      }
    }
    return problem;
  }

  std::size_t scans_;
  const std::vector<PoseEdge>& edges_;
  const PoseGraphOptions& options_;
  std::vector<WhiteEdge> white_;
};

/// Inverse of a normal matrix in which unknowns of different units stand; a direction that nothing
/// measures gets a huge variance.
Eigen::MatrixXd inverse_of(const Eigen::MatrixXd& normal) {
  const Eigen::VectorXd scale = normal.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd unit = scale.asDiagonal() * normal * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver((unit + unit.transpose()) / 2);
  const Eigen::VectorXd variance = solver.eigenvalues().cwiseMax(1e-13).cwiseInverse();
  const Eigen::MatrixXd inverse =
      solver.eigenvectors() * variance.asDiagonal() * solver.eigenvectors().transpose();
  return scale.asDiagonal() * inverse * scale.asDiagonal();
}

void Graph::find_covariance(const std::vector<double>& weights, PoseGraphResult& result) const {
  const auto all = static_cast<Eigen::Index>(6 * scans_);
  result.covariance.assign(scans_, Matrix6::Zero());
  result.joint_covariance = Eigen::MatrixXd::Zero(all, all);
  std::vector<std::array<double, 6>> change(scans_, std::array<double, 6>{});
  const auto problem = build(weights, result.world_from_scan, change);
  const std::vector<bool> stays = held(weights);
  ceres::Problem::EvaluateOptions how;
  std::vector<Eigen::Index> column(scans_, -1);
  for (std::size_t i = 0; i < scans_; ++i) {
    if (stays[i] || !problem->HasParameterBlock(change[i].data())) continue;
    column[i] = 6 * static_cast<Eigen::Index>(how.parameter_blocks.size());
    how.parameter_blocks.push_back(change[i].data());
  }
  if (how.parameter_blocks.empty()) return;
  ceres::CRSMatrix crs;
  problem->Evaluate(how, nullptr, nullptr, nullptr, &crs);
  Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(crs.num_rows, crs.num_cols);
  for (int r = 0; r < crs.num_rows; ++r) {
    for (int k = crs.rows[std::size_t(r)]; k < crs.rows[std::size_t(r) + 1]; ++k) {
      jacobian(r, crs.cols[std::size_t(k)]) = crs.values[std::size_t(k)];
    }
  }
  const Eigen::MatrixXd covariance = inverse_of(jacobian.transpose() * jacobian);
  for (std::size_t i = 0; i < scans_; ++i) {
    for (std::size_t k = 0; k < scans_; ++k) {
      if (column[i] < 0 || column[k] < 0) continue;
      result.joint_covariance.block<6, 6>(static_cast<Eigen::Index>(6 * i),
                                          static_cast<Eigen::Index>(6 * k)) =
          covariance.block<6, 6>(column[i], column[k]);
    }
    if (column[i] >= 0) result.covariance[i] = covariance.block<6, 6>(column[i], column[i]);
  }
  Eigen::Index row = 0;
  for (std::size_t e = 0; e < edges_.size(); ++e) {
    if (!(weights[e] > 0)) continue;
    const Eigen::MatrixXd part = jacobian.middleRows(row, 6);
    const double used = (part * covariance).cwiseProduct(part).sum();
    const int rank = std::max(1, white_[e].rank);
    result.edges[e].redundancy = std::clamp(1 - used / rank, 0.0, 1.0);
    row += 6;
  }
}

/// Geman and McClure's weight at the control parameter mu; 1 is the kernel itself.
double kernel(double chi2, double bound, double mu) {
  const double w = mu * bound / (chi2 + mu * bound);
  return w * w;
}

std::vector<double> all_chi2(const Graph& graph, std::size_t edges, const Poses& poses) {
  std::vector<double> chi2(edges);
  for (std::size_t e = 0; e < edges; ++e) chi2[e] = graph.chi2(e, poses);
  return chi2;
}

/// Graduated non-convexity for Geman and McClure's kernel (Yang et al. 2020, section IV): from the
/// plain least squares, whose cost is convex, step by step to the kernel that gives edges up.
void graduate(const Graph& graph, double bound, std::vector<double>& weights, Poses& poses) {
  const std::vector<double> start = all_chi2(graph, weights.size(), poses);
  double mu = std::max(1.0, 2 * *std::max_element(start.begin(), start.end()) / bound);
  for (bool last = false; !last; mu /= 1.4) {
    last = mu <= 1;
    const std::vector<double> chi2 = all_chi2(graph, weights.size(), poses);
    for (std::size_t e = 0; e < weights.size(); ++e) {
      weights[e] = std::max(1e-12, kernel(chi2[e], bound, std::max(mu, 1.0)));
    }
    graph.solve(weights, poses);
  }
}

/// Least squares over the edges within the bound alone. The worst edge goes first, as it pulls at
/// the others; an edge that the rest agrees with comes back.
void settle(const Graph& graph, double bound, std::vector<double>& weights, Poses& poses) {
  std::vector<double> chi2 = all_chi2(graph, weights.size(), poses);
  for (std::size_t e = 0; e < weights.size(); ++e) weights[e] = chi2[e] <= bound ? 1 : 0;
  std::vector<bool> dropped(weights.size());
  for (std::size_t round = 0; round <= 2 * weights.size(); ++round) {
    graph.solve(weights, poses);
    chi2 = all_chi2(graph, weights.size(), poses);
    std::size_t worst = weights.size();
    bool changed = false;
    for (std::size_t e = 0; e < weights.size(); ++e) {
      if (weights[e] > 0 && chi2[e] > bound && (worst == weights.size() || chi2[e] > chi2[worst])) {
        worst = e;
      }
      if (weights[e] == 0 && !dropped[e] && chi2[e] <= bound) {
        weights[e] = 1;
        changed = true;
      }
    }
    if (worst < weights.size()) {
      weights[worst] = 0;
      dropped[worst] = true;
    } else if (!changed) {
      return;
    }
  }
}

void describe(const Graph& graph, const std::vector<double>& weights, PoseGraphResult& result) {
  int rows = 0;
  for (std::size_t e = 0; e < weights.size(); ++e) {
    const auto twist = graph.twist(e, result.world_from_scan);
    EdgeResidual& residual = result.edges[e];
    residual.translation = twist.head<3>().norm();
    residual.rotation = twist.tail<3>().norm();
    residual.chi2 = graph.chi2(e, result.world_from_scan);
    residual.outlier = weights[e] == 0;
    if (residual.outlier) continue;
    result.chi2 += residual.chi2;
    rows += graph.rank(e);
  }
  int free_poses = 0;
  for (std::size_t i = 0; i < result.component.size(); ++i) {
    free_poses += result.component[i] == i ? 0 : 1;
  }
  result.degrees_of_freedom = rows - 6 * free_poses;
}

}  // namespace

void PoseGraphOptions::check() const {
  require(outlier_chi2 > 0 && std::isfinite(outlier_chi2),
          "outlier_chi2 is ",
          outlier_chi2,
          "; give a value above 0");
  require(max_iterations >= 1, "max_iterations is ", max_iterations, "; give at least 1");
}

PoseGraphResult solve_pose_graph(std::size_t scans,
                                 const std::vector<PoseEdge>& edges,
                                 const std::vector<RigidTransform>& world_from_scan_guess,
                                 const PoseGraphOptions& options) {
  options.check();
  require(scans >= 1, "a pose graph needs at least one scan");
  require(options.anchor < scans, "anchor is ", options.anchor, " of ", scans, " scans");
  require(world_from_scan_guess.size() == scans,
          "expected ",
          scans,
          " guessed poses, one per scan, got ",
          world_from_scan_guess.size());
  for (const PoseEdge& edge : edges) {
    require(edge.from < scans && edge.to < scans && edge.from != edge.to,
            "an edge joins scan ",
            edge.from,
            " with scan ",
            edge.to,
            " of ",
            scans,
            "; it must join two different scans");
  }
  const Graph graph(scans, edges, options);
  PoseGraphResult result;
  result.world_from_scan = world_from_scan_guess;
  result.edges.resize(edges.size());
  std::vector<double> weights(edges.size(), 1.0);
  graph.solve(weights, result.world_from_scan);
  if (options.robust && !edges.empty()) {
    graduate(graph, options.outlier_chi2, weights, result.world_from_scan);
    settle(graph, options.outlier_chi2, weights, result.world_from_scan);
  }
  result.component = components_of(scans, edges, weights);
  for (std::size_t i = 0; i < scans; ++i) {
    result.connected.push_back(result.component[i] == result.component[options.anchor]);
  }
  describe(graph, weights, result);
  graph.find_covariance(weights, result);
  return result;
}

}  // namespace facula
