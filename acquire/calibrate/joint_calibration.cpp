// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/calibrate/joint_calibration.hpp>
#include <facula/acquire/calibrate/joint_figures.hpp>
#include <facula/acquire/calibrate/joint_fit.hpp>
#include <facula/acquire/calibrate/joint_scales.hpp>
#include <facula/acquire/calibrate/joint_start.hpp>
#include <facula/acquire/calibrate/joint_warnings.hpp>
#include <facula/acquire/core/error.hpp>

#include <cmath>
#include <numbers>
#include <set>
#include <sstream>

namespace facula {
namespace {

constexpr double kRaisedFrom = 2;  // fold scatter beyond what few folds show by chance [1]

void require_determined(const JointSolution& solution) {
  require(solution.undetermined.empty(),
          "the views cannot decide ",
          solution.undetermined,
          "; ",
          advice_for(solution.undetermined));
  require(solution.residuals > solution.parameters,
          "expected more numbers observed than estimated, got ",
          solution.residuals,
          " for ",
          solution.parameters,
          "; add views or leave out fewer points");
}

/// Puts z = 0 of a turntable back on its first flat board, which the fit may have moved along the
/// axis: no observation holds it there.
void settle_scan_frame(const std::vector<JointSight>& sights, JointState& state) {
  if (state.rig.axis.kind != AxisKind::kTurntable) return;
  for (const JointSight& sight : sights) {
    if (!sight.placed) continue;
    const RigidTransform& board = state.poses[sight.pose];
    const Eigen::Vector3d normal = board.rotation * Eigen::Vector3d::UnitZ();
    if (std::abs(normal.z()) < std::cos(20 * std::numbers::pi / 180)) continue;
    const double height = normal.dot(board.translation) / normal.z();
    std::set<std::size_t> placements;
    for (const JointSight& s : sights) {
      if (s.placed) placements.insert(s.pose);
    }
    for (const std::size_t p : placements) state.poses[p].translation.z() -= height;
    state.rig.axis.scan_from_camera.translation.z() -= height;
    return;
  }
}

/// Covariance of the rig, raised where the folds scatter more than it explains.
void give_covariance(const ScaledFit& fit, JointCalibration& result) {
  const auto n = static_cast<Eigen::Index>(fit.freedom.rig_parameters.size());
  if (n == 0) return;
  RigCovariance covariance;
  covariance.parameters = fit.freedom.rig_parameters;
  covariance.matrix = fit.solution.covariance.topLeftCorner(n, n);
  covariance.matrix = (0.5 * (covariance.matrix + covariance.matrix.transpose())).eval();
  if (result.fold_scatter > kRaisedFrom) {
    covariance.matrix *= result.fold_scatter * result.fold_scatter;
    std::ostringstream text;
    text.precision(3);
    text << "without a part of the views the parameters move " << result.fold_scatter
         << " times as far as the residuals explain: errors are shared within views (a bent board, "
            "wrong distortion, axis play); all sigmas were raised by this factor";
    result.warnings.push_back(text.str());
  }
  result.rig.covariance = std::move(covariance);
}

void give_poses(const CalibrationSet& set,
                const std::vector<JointSight>& sights,
                const JointState& state,
                JointCalibration& result) {
  result.camera_from_board.assign(set.views.size(), {});
  result.positions.assign(set.views.size(), 0.0);
  for (std::size_t v = 0; v < set.views.size(); ++v) {
    result.positions[v] = set.views[v].position.value_or(0);
  }
  for (std::size_t i = 0; i < sights.size(); ++i) {
    result.camera_from_board[sights[i].view] = camera_from_board(state, sights[i], i);
    result.positions[sights[i].view] = state.positions[i];
  }
}

void add_warnings(const ScaledFit& fit, const JointFolds& folds, JointCalibration& result) {
  for (const BoardScale& scale : fit.scales) {
    std::string sentence = scale_sentence(scale);
    if (!sentence.empty()) result.warnings.push_back(std::move(sentence));
  }
  if (!folds.decided && !folds.reason.empty()) {
    result.warnings.push_back("no view could be held out: " + folds.reason + "; add views");
  }
  for (std::string& sentence : weak_parameters(result.rig)) {
    result.warnings.push_back(std::move(sentence));
  }
}

}  // namespace

void JointOptions::check() const {
  require(
      radial_terms >= 0 && radial_terms <= 3, "radial_terms: expected 0 to 3, got ", radial_terms);
  require(point_sigma >= 0 && std::isfinite(point_sigma),
          "point_sigma: expected 0 or more, got ",
          point_sigma);
  require(line_sigma_ratio >= 0 && std::isfinite(line_sigma_ratio),
          "line_sigma_ratio: expected 0 or more, got ",
          line_sigma_ratio);
  require(position_sigma >= 0 && std::isfinite(position_sigma),
          "position_sigma: expected 0 or more, got ",
          position_sigma);
  require(outlier_sigmas >= 3, "outlier_sigmas: expected 3 or more, got ", outlier_sigmas);
  require(folds == 0 || (folds >= 2 && folds <= 1000),
          "folds: expected 0 for none, or 2 to 1000, got ",
          folds);
}

JointCalibration calibrate_jointly(const CalibrationSet& set, const JointOptions& options) {
  options.check();
  JointStart start = start_jointly(set, options);
  JointNoise noise;
  if (options.point_sigma > 0) noise.point_sigma = options.point_sigma;
  if (options.line_sigma_ratio > 0) noise.line_ratio = options.line_sigma_ratio;
  noise.position_sigma = options.position_sigma;

  ScaledFit fit = fit_with_scales(options, start.sights, noise, start.state);
  require_determined(fit.solution);
  settle_scan_frame(start.sights, start.state);
  fit.solution = solve_joint(start.sights, fit.freedom, noise, true, start.state);
  JointFolds folds;
  if (options.folds > 0) folds = hold_out(fit.freedom, options, start.sights, noise, start.state);

  JointCalibration result;
  result.rig = start.state.rig;
  result.point_sigma = noise.point_sigma;
  result.line_sigma_ratio = noise.line_ratio;
  result.reduced_chi_squared =
      fit.solution.chi_squared /
      static_cast<double>(fit.solution.residuals - fit.solution.parameters);
  result.scales = fit.scales;
  result.rejected = std::move(start.rejected);
  result.warnings = std::move(start.warnings);
  fill_figures(set, start.sights, start.state, folds, result);
  result.fold_scatter = fold_scatter(folds, fit.solution.covariance);
  give_covariance(fit, result);
  give_poses(set, start.sights, start.state, result);
  add_warnings(fit, folds, result);
  return result;
}

}  // namespace facula
