// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/calibrate/ceres_bridge.hpp>
#include <facula/acquire/calibrate/joint_solver.hpp>
#include <facula/acquire/core/error.hpp>

#include <algorithm>
#include <array>
#include <memory>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/SparseCore>
#include <ceres/ceres.h>

namespace facula {
namespace {

constexpr double kScalePrior = 0.3;  // keeps a scale that nothing ties down from running away [1]

/// The names of one block's numbers, and from its numbers to the names' units.
struct BlockNames {
  std::vector<std::string> names;
  std::vector<double> unit;
};

BlockNames block_names(const std::vector<std::string>& names) {
  BlockNames block{names, {}};
  for (const std::string& name : names) block.unit.push_back(name.ends_with("_mm") ? 1e3 : 1);
  return block;
}

/// One least squares being built, solved and taken apart. Blocks hold changes from the state.
class JointProblem final : public ceres::EvaluationCallback {
 public:
  JointProblem(const std::vector<JointSight>& sights,
               const JointFreedom& freedom,
               const JointNoise& noise,
               const JointState& state)
      : sights_(sights), freedom_(freedom), noise_(noise), state_(state) {
    name_blocks();
    rig_values_.assign(rig_blocks_.size(), {});
    poses_.assign(state.poses.size(), {});
    scales_.assign(state.scales.size(), 0.0);
    positions_.assign(state.positions.size(), 0.0);
    views_.resize(sights.size());
    sheets_.resize(state.rig.lasers.size());
    PrepareForEvaluation(true, true);
    if (freedom.robust_scale > 0) loss_ = std::make_unique<ceres::CauchyLoss>(freedom.robust_scale);
    ceres::Problem::Options options;
    options.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    options.evaluation_callback = this;
    problem_ = std::make_unique<ceres::Problem>(options);
    for (std::size_t i = 0; i < sights.size(); ++i) {
      if (freedom.sights[i]) add_sight(i);
    }
    add_priors();
    hold_the_rest();
  }

  /// What the residuals of a view share.
  void PrepareForEvaluation(bool /*jacobians*/, bool new_point) override {
    if (!new_point) return;
    for (std::size_t i = 0; i < sights_.size(); ++i) {
      if (!freedom_.sights[i]) continue;
      const JointViewChange change{poses_[sights_[i].pose].data(), axis(), &positions_[i]};
      views_[i] = joint_view_pose(state_, sights_, i, change);
    }
    for (std::size_t l = 0; l < sheets_.size(); ++l) {
      sheets_[l] = joint_sheet(state_.rig.lasers[l], laser(l));
    }
  }

  void solve() {
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::DENSE_SCHUR;
    // A robust fit only has to show which observations are wrong.
    const bool rough = freedom_.robust_scale > 0;
    options.max_num_iterations = rough ? 30 : 100;
    options.function_tolerance = rough ? 1e-4 : 1e-9;
    options.parameter_tolerance = rough ? 1e-6 : 1e-10;
    options.gradient_tolerance = 1e-14;
    options.initial_trust_region_radius = 1e7;  // the start is good: nearly Gauss-Newton
    options.num_threads = 1;
    options.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(options, problem_.get(), &summary);
    require(summary.termination_type != ceres::FAILURE,
            "the calibration's least squares could not start: ",
            summary.message,
            "; check that the board's size and the start camera are about right");
    solution_.chi_squared = 2 * summary.final_cost;
    solution_.rig_changes = rig_changes();
  }

  /// Changes per rig parameter that is free, in the units of the names.
  Eigen::VectorXd rig_changes() const {
    Eigen::VectorXd changes(static_cast<Eigen::Index>(freedom_.rig_parameters.size()));
    for (std::size_t p = 0; p < freedom_.rig_parameters.size(); ++p) {
      const auto [b, k] = place_of(freedom_.rig_parameters[p]);
      changes[static_cast<Eigen::Index>(p)] = rig_values_[b][k] * rig_blocks_[b].unit[k];
    }
    return changes;
  }

  void apply_to(JointState& state) const {
    state.rig = moved(state.rig, freedom_.rig_parameters, rig_changes());
    for (std::size_t i = 0; i < poses_.size(); ++i) {
      const auto& d = poses_[i];
      RigidTransform change;
      const Eigen::Vector3d w(d[3], d[4], d[5]);
      if (w.norm() > 0) change.rotation = Eigen::AngleAxisd(w.norm(), w.normalized());
      change.translation = {d[0], d[1], d[2]};
      state.poses[i] = state.poses[i] * change;
    }
    for (std::size_t i = 0; i < scales_.size(); ++i) state.scales[i] += scales_[i];
    for (std::size_t i = 0; i < positions_.size(); ++i) state.positions[i] += positions_[i];
  }

  JointSolution& solution() { return solution_; }

  void find_covariance();

 private:
  void name_blocks() {
    const std::vector<std::string> names = rig_parameter_names(state_.rig);
    const auto part = [&](std::size_t begin, std::size_t count) {
      const auto first = names.begin() + static_cast<std::ptrdiff_t>(begin);
      return block_names({first, first + static_cast<std::ptrdiff_t>(count)});
    };
    rig_blocks_.push_back(part(0, 9));
    for (std::size_t l = 0; l < state_.rig.lasers.size(); ++l) {
      rig_blocks_.push_back(part(9 + 4 * l, 4));
    }
    const std::size_t begin = 9 + 4 * state_.rig.lasers.size();
    rig_blocks_.push_back(part(begin, names.size() - begin));
  }

  double* camera() { return rig_values_.front().data(); }
  double* laser(std::size_t l) { return rig_values_[1 + l].data(); }
  double* axis() { return rig_values_.back().data(); }

  std::pair<std::size_t, std::size_t> place_of(const std::string& name) const {
    for (std::size_t b = 0; b < rig_blocks_.size(); ++b) {
      const auto& names = rig_blocks_[b].names;
      const auto it = std::find(names.begin(), names.end(), name);
      if (it != names.end()) return {b, static_cast<std::size_t>(it - names.begin())};
    }
    fail("no parameter '", name, "' in the rig");
  }

  bool is_free(const std::string& name) const {
    const auto& free = freedom_.rig_parameters;
    return std::find(free.begin(), free.end(), name) != free.end();
  }

  void add_sight(std::size_t i) {
    const JointSight& sight = sights_[i];
    std::vector<double*> blocks{camera(), poses_[sight.pose].data(), &scales_[sight.board]};
    if (sight.placed) blocks.insert(blocks.end(), {axis(), &positions_[i]});
    for (const JointPoint& point : sight.points) {
      if (point.wrong) continue;
      solution_.residuals += 2;
      problem_->AddResidualBlock(
          new JointPointCost(state_, sight, point, noise_.point_sigma, views_[i]),
          loss_.get(),
          blocks);
    }
    for (std::size_t p = 0; freedom_.lines && p < sight.lines.size(); ++p) {
      if (!sight.lines[p].wrong) add_line_point(i, p);
    }
  }

  void add_line_point(std::size_t i, std::size_t p) {
    const JointSight& sight = sights_[i];
    const JointLinePoint& point = sight.lines[p];
    const Camera& c = state_.rig.camera;
    const auto normalized = c.undistort(point.pixel);
    const double slope = line_residual(state_, sights_, i, p).slope;
    if (!normalized || !std::isfinite(slope)) return;
    const LaserPlane& plane = state_.rig.lasers[point.laser];
    const bool bends = plane.bow != 0 || is_free("laser." + plane.name + ".bow_rad");
    const double unchanged[9] = {};
    const JointLineBase base{c,
                             plane,
                             *normalized,
                             joint_pixel(c, unchanged, *normalized).by_normalized.inverse(),
                             slope * point.sigma * noise_.line_ratio,
                             bends};
    solution_.residuals += 1;
    std::vector<double*> blocks{camera(), laser(point.laser), poses_[sight.pose].data()};
    if (sight.placed) blocks.insert(blocks.end(), {axis(), &positions_[i]});
    problem_->AddResidualBlock(
        new JointLineCost(base, point.pixel, sight.placed, views_[i], sheets_[point.laser]),
        loss_.get(),
        blocks);
  }

  void add_priors() {
    for (std::size_t b = 0; b < scales_.size(); ++b) {
      if (!freedom_.scales[b] || !problem_->HasParameterBlock(&scales_[b])) continue;
      problem_->AddResidualBlock(
          new JointPriorCost(state_.scales[b] - 1, kScalePrior), nullptr, &scales_[b]);
    }
    for (std::size_t i = 0; i < positions_.size() && noise_.position_sigma > 0; ++i) {
      if (!problem_->HasParameterBlock(&positions_[i])) continue;
      const double offset = state_.positions[i] - sights_[i].position;
      problem_->AddResidualBlock(
          new JointPriorCost(offset, noise_.position_sigma), nullptr, &positions_[i]);
    }
  }

  /// Holds a block, or those of its numbers that are not free, and lists what stays free.
  void hold(double* block, int size, const std::vector<int>& held, bool of_the_rig) {
    if (!problem_->HasParameterBlock(block)) return;
    if (static_cast<int>(held.size()) == size) {
      problem_->SetParameterBlockConstant(block);
      return;
    }
    if (!held.empty()) problem_->SetManifold(block, new ceres::SubsetManifold(size, held));
    free_blocks_.push_back(block);
    const std::size_t free = static_cast<std::size_t>(size) - held.size();
    solution_.parameters += free;
    if (of_the_rig) global_count_ += free;
  }

  void hold_the_rest() {
    const int last = static_cast<int>(rig_blocks_.size()) - 1;
    for (int b = 0; b <= last; ++b) {
      const auto& names = rig_blocks_[static_cast<std::size_t>(b)].names;
      const int size = b == 0 ? 9 : 4;
      std::vector<int> held;
      for (int k = 0; k < size; ++k) {
        const auto at = static_cast<std::size_t>(k);
        if (at >= names.size() || !is_free(names[at])) {
          held.push_back(k);
        } else if (problem_->HasParameterBlock(rig_values_[static_cast<std::size_t>(b)].data())) {
          columns_.push_back(names[at]);
          column_units_.push_back(rig_blocks_[static_cast<std::size_t>(b)].unit[at]);
        }
      }
      hold(rig_values_[static_cast<std::size_t>(b)].data(), size, held, true);
    }
    for (std::size_t b = 0; b < scales_.size(); ++b) {
      if (freedom_.scales[b] && problem_->HasParameterBlock(&scales_[b])) {
        columns_.push_back("size of board " + std::to_string(b + 1));
        column_units_.push_back(1);
      }
      hold(&scales_[b], 1, freedom_.scales[b] ? std::vector<int>{} : std::vector<int>{0}, true);
    }
    const std::vector<int> all{0, 1, 2, 3, 4, 5};
    for (std::size_t p = 0; p < poses_.size(); ++p) {
      hold(poses_[p].data(), 6, freedom_.poses[p] ? std::vector<int>{} : all, false);
    }
    for (double& position : positions_) {
      const bool free = noise_.position_sigma > 0;
      hold(&position, 1, free ? std::vector<int>{} : std::vector<int>{0}, false);
    }
  }

  const std::vector<JointSight>& sights_;
  const JointFreedom& freedom_;
  const JointNoise& noise_;
  const JointState& state_;
  std::vector<BlockNames> rig_blocks_;  ///< camera, each laser, axis
  std::vector<std::array<double, 9>> rig_values_;
  std::vector<std::array<double, 6>> poses_;
  std::vector<double> scales_;
  std::vector<double> positions_;
  std::vector<JointViewPose> views_;  ///< where the boards stand at the solver's parameters
  std::vector<JointSheet> sheets_;
  std::unique_ptr<ceres::LossFunction> loss_;
  std::unique_ptr<ceres::Problem> problem_;
  std::vector<double*> free_blocks_;  ///< first those of the rig and the scales
  std::vector<std::string> columns_;  ///< names of the first columns of the Jacobian
  std::vector<double> column_units_;
  std::size_t global_count_ = 0;
  JointSolution solution_;
};

/// Covariance of the first columns by the Schur complement of the poses in the normal matrix.
void JointProblem::find_covariance() {
  ceres::Problem::EvaluateOptions options;
  options.parameter_blocks = free_blocks_;
  ceres::CRSMatrix crs;
  PrepareForEvaluation(true, true);
  problem_->Evaluate(options, nullptr, nullptr, nullptr, &crs);
  const Eigen::Map<const Eigen::SparseMatrix<double, Eigen::RowMajor>> jacobian(
      crs.num_rows,
      crs.num_cols,
      static_cast<Eigen::Index>(crs.values.size()),
      crs.rows.data(),
      crs.cols.data(),
      crs.values.data());
  const Eigen::SparseMatrix<double> by_column = jacobian;
  Eigen::MatrixXd normal = Eigen::SparseMatrix<double>(by_column.transpose() * by_column);
  // Every column of length 1: the parameters' units lie many orders apart.
  const Eigen::VectorXd length = normal.diagonal().cwiseSqrt().cwiseMax(1e-100);
  normal =
      (length.cwiseInverse().asDiagonal() * normal * length.cwiseInverse().asDiagonal()).eval();
  const auto g = static_cast<Eigen::Index>(global_count_);
  const Eigen::Index l = normal.rows() - g;
  Eigen::MatrixXd rest = normal.topLeftCorner(g, g);
  if (l > 0) {
    const Eigen::LLT<Eigen::MatrixXd> poses(normal.bottomRightCorner(l, l));
    if (poses.info() != Eigen::Success) {
      solution_.undetermined = "the pose of a board";
      return;
    }
    rest -= normal.topRightCorner(g, l) * poses.solve(normal.bottomLeftCorner(l, g));
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(rest);
  if (g > 0 && !(eigen.eigenvalues()[0] > 1e-13)) {
    Eigen::Index worst = 0;
    eigen.eigenvectors().col(0).cwiseAbs().maxCoeff(&worst);
    solution_.undetermined = columns_[static_cast<std::size_t>(worst)];
    return;
  }
  Eigen::MatrixXd inverse = eigen.eigenvectors() * eigen.eigenvalues().cwiseInverse().asDiagonal() *
                            eigen.eigenvectors().transpose();
  const Eigen::Map<const Eigen::VectorXd> unit(column_units_.data(), g);
  const Eigen::VectorXd scale = unit.cwiseQuotient(length.head(g));
  inverse = (scale.asDiagonal() * inverse * scale.asDiagonal()).eval();
  // From the blocks' order to the freedom's.
  std::vector<std::string> wanted = freedom_.rig_parameters;
  for (std::size_t b = 0; b < scales_.size(); ++b) {
    if (freedom_.scales[b]) wanted.push_back("size of board " + std::to_string(b + 1));
  }
  std::vector<Eigen::Index> at;
  for (const std::string& name : wanted) {
    const auto it = std::find(columns_.begin(), columns_.end(), name);
    if (it == columns_.end()) {
      solution_.undetermined = name;
      return;
    }
    at.push_back(it - columns_.begin());
  }
  solution_.covariance = inverse(at, at);
}

}  // namespace

JointSolution solve_joint(const std::vector<JointSight>& sights,
                          const JointFreedom& freedom,
                          const JointNoise& noise,
                          bool with_covariance,
                          JointState& state) {
  const JointState start = state;
  JointProblem problem(sights, freedom, noise, start);
  problem.solve();
  problem.apply_to(state);
  if (with_covariance) problem.find_covariance();
  return problem.solution();
}

}  // namespace facula
