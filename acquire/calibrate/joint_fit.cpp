// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/calibrate/joint_fit.hpp>
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/median.hpp>
#include <facula/acquire/core/parallel.hpp>
#include <facula/acquire/rig/rig_parameters.hpp>

#include <algorithm>
#include <cmath>

namespace facula {
namespace {

constexpr int kRounds = 8;  // of marking gross errors; the marks then stay

// Middle of |x| and of sqrt(x^2 + y^2) for standard normal x, y.
constexpr double kMedianNormal = 0.6745;
constexpr double kMedianRayleigh = 1.1774;

/// Below these no camera and no detector repeats itself; they keep weights finite on perfect data.
constexpr double kLeastPointSigma = 1e-4;  // [px]
constexpr double kLeastLineRatio = 1e-3;   // [1]

/// Sizes of all residuals: points in pixels, line points in their sigmas. NaN counts as infinite.
struct ResidualSizes {
  std::vector<std::vector<double>> points;
  std::vector<std::vector<double>> lines;
};

double finite_or_huge(double value) {
  return std::isfinite(value) ? value : 1e30;
}

ResidualSizes residual_sizes(const JointState& state, const std::vector<JointSight>& sights) {
  ResidualSizes sizes;
  sizes.points.resize(sights.size());
  sizes.lines.resize(sights.size());
  for (std::size_t i = 0; i < sights.size(); ++i) {
    for (std::size_t p = 0; p < sights[i].points.size(); ++p) {
      sizes.points[i].push_back(finite_or_huge(point_residual(state, sights, i, p).norm()));
    }
    for (std::size_t p = 0; p < sights[i].lines.size(); ++p) {
      const double pixels = std::abs(line_residual(state, sights, i, p).pixels());
      sizes.lines[i].push_back(finite_or_huge(pixels / sights[i].lines[p].sigma));
    }
  }
  return sizes;
}

std::vector<double> joined(const std::vector<std::vector<double>>& parts) {
  std::vector<double> all;
  for (const auto& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

/// Noise from the middle of the residuals, which gross errors cannot spoil.
void noise_by_median(const ResidualSizes& sizes, const JointOptions& options, JointNoise& noise) {
  std::vector<double> points = joined(sizes.points);
  std::vector<double> lines = joined(sizes.lines);
  if (options.point_sigma <= 0) {
    noise.point_sigma = std::max(median(points) / kMedianRayleigh, kLeastPointSigma);
  }
  if (options.line_sigma_ratio <= 0 && !lines.empty()) {
    noise.line_ratio = std::max(median(lines) / kMedianNormal, kLeastLineRatio);
  }
}

/// Marks what lies too far off; returns whether any mark changed.
bool mark_wrong(const ResidualSizes& sizes,
                const JointOptions& options,
                const JointNoise& noise,
                std::vector<JointSight>& sights) {
  bool changed = false;
  const auto mark = [&](bool& wrong, double size, double sigma) {
    const bool is_wrong = size > options.outlier_sigmas * sigma;
    changed = changed || is_wrong != wrong;
    wrong = is_wrong;
  };
  for (std::size_t i = 0; i < sights.size(); ++i) {
    for (std::size_t p = 0; p < sights[i].points.size(); ++p) {
      mark(sights[i].points[p].wrong, sizes.points[i][p], noise.point_sigma);
    }
    for (std::size_t p = 0; p < sights[i].lines.size(); ++p) {
      mark(sights[i].lines[p].wrong, sizes.lines[i][p], noise.line_ratio);
    }
  }
  return changed;
}

/// Noise from the squares of what takes part, each kind less the parameters it decides.
void noise_by_squares(const ResidualSizes& sizes,
                      const std::vector<JointSight>& sights,
                      const JointOptions& options,
                      std::size_t parameters,
                      JointNoise& noise) {
  double point2 = 0;
  double line2 = 0;
  double point_count = 0;
  double line_count = 0;
  for (std::size_t i = 0; i < sights.size(); ++i) {
    for (std::size_t p = 0; p < sights[i].points.size(); ++p) {
      if (sights[i].points[p].wrong) continue;
      point2 += sizes.points[i][p] * sizes.points[i][p];
      point_count += 2;
    }
    for (std::size_t p = 0; p < sights[i].lines.size(); ++p) {
      if (sights[i].lines[p].wrong) continue;
      line2 += sizes.lines[i][p] * sizes.lines[i][p];
      line_count += 1;
    }
  }
  // The lines decide the sheets, the points nearly everything else.
  std::size_t lasers = 0;
  for (const JointSight& sight : sights) {
    for (const JointLinePoint& p : sight.lines) lasers = std::max(lasers, p.laser + 1);
  }
  const double line_parameters = static_cast<double>((options.bow ? 4 : 3) * lasers);
  const double point_freedom =
      std::max(1.0, point_count - static_cast<double>(parameters) + line_parameters);
  const double line_freedom = std::max(1.0, line_count - line_parameters);
  if (options.point_sigma <= 0) {
    noise.point_sigma = std::max(std::sqrt(point2 / point_freedom), kLeastPointSigma);
  }
  if (options.line_sigma_ratio <= 0 && line_count > 0) {
    noise.line_ratio = std::max(std::sqrt(line2 / line_freedom), kLeastLineRatio);
  }
}

}  // namespace

std::vector<std::string> joint_parameters(const Rig& rig,
                                          const std::vector<JointSight>& sights,
                                          const JointOptions& options) {
  std::vector<std::string> names;
  const bool any_placed =
      std::any_of(sights.begin(), sights.end(), [](const JointSight& s) { return s.placed; });
  for (const std::string& name : rig_parameter_names(rig)) {
    const bool of_camera = name.starts_with("camera.");
    if (of_camera && options.fix_camera) continue;
    if (!options.tangential && (name == "camera.p1" || name == "camera.p2")) continue;
    if (name == "camera.k1" && options.radial_terms < 1) continue;
    if (name == "camera.k2" && options.radial_terms < 2) continue;
    if (name == "camera.k3" && options.radial_terms < 3) continue;
    if (name.ends_with(".bow_rad") && !options.bow) continue;
    if (name.starts_with("axis.") && !any_placed) continue;
    names.push_back(name);
  }
  return names;
}

JointFreedom full_freedom(const JointState& state,
                          const std::vector<JointSight>& sights,
                          const JointOptions& options,
                          const std::vector<bool>& scales) {
  JointFreedom freedom;
  freedom.rig_parameters = joint_parameters(state.rig, sights, options);
  freedom.scales = scales;
  freedom.poses.assign(state.poses.size(), true);
  freedom.sights.assign(sights.size(), true);
  return freedom;
}

JointSolution fit_robustly(const JointFreedom& freedom,
                           const JointOptions& options,
                           std::vector<JointSight>& sights,
                           JointNoise& noise,
                           JointState& state) {
  JointFreedom robust = freedom;
  robust.robust_scale = 2.5;
  for (JointSight& sight : sights) {
    for (JointPoint& p : sight.points) p.wrong = false;
    for (JointLinePoint& p : sight.lines) p.wrong = false;
  }
  noise_by_median(residual_sizes(state, sights), options, noise);
  for (int round = 0; round < 2; ++round) {
    const JointNoise before = noise;
    solve_joint(sights, robust, noise, false, state);
    noise_by_median(residual_sizes(state, sights), options, noise);
    if (before.point_sigma == noise.point_sigma && before.line_ratio == noise.line_ratio) break;
  }
  JointSolution solution;
  for (int round = 0; round < kRounds; ++round) {
    const bool changed = mark_wrong(residual_sizes(state, sights), options, noise, sights);
    if (!changed && round > 0) break;
    solution = solve_joint(sights, freedom, noise, false, state);
    noise_by_squares(residual_sizes(state, sights), sights, options, solution.parameters, noise);
  }
  return solve_joint(sights, freedom, noise, true, state);
}

JointFolds hold_out(const JointFreedom& freedom,
                    const JointOptions& options,
                    const std::vector<JointSight>& sights,
                    const JointNoise& noise,
                    const JointState& state) {
  JointFolds folds;
  const std::size_t count = std::min(static_cast<std::size_t>(options.folds), sights.size());
  if (count < 2) {
    folds.reason = "there is only one view";
    return folds;
  }
  for (std::size_t i = 0; i < sights.size(); ++i) folds.fold_of_sight.push_back(i % count);
  folds.states.assign(count, state);
  folds.changes.resize(static_cast<Eigen::Index>(freedom.rig_parameters.size()),
                       static_cast<Eigen::Index>(count));
  std::vector<std::string> undetermined(count);
  const auto fit_fold = [&](std::size_t k, std::size_t) {
    JointFreedom others = freedom;
    JointFreedom own = freedom;
    own.rig_parameters.clear();
    own.scales.assign(freedom.scales.size(), false);
    own.lines = false;
    std::vector<bool> shown_by_others(state.poses.size(), false);
    for (std::size_t i = 0; i < sights.size(); ++i) {
      const bool held = folds.fold_of_sight[i] == k;
      others.sights[i] = !held;
      own.sights[i] = held;
      if (!held) shown_by_others[sights[i].pose] = true;
    }
    for (std::size_t p = 0; p < own.poses.size(); ++p) own.poses[p] = !shown_by_others[p];
    const JointSolution solution = solve_joint(sights, others, noise, true, folds.states[k]);
    undetermined[k] = solution.undetermined;
    if (!solution.undetermined.empty()) return;
    folds.changes.col(static_cast<Eigen::Index>(k)) = solution.rig_changes;
    solve_joint(sights, own, noise, false, folds.states[k]);
  };
  parallel_for(count, fit_fold, {.num_threads = options.num_threads, .chunk = 1});
  for (const std::string& name : undetermined) {
    if (name.empty()) continue;
    folds.reason = "the other views cannot decide " + name;
    return folds;
  }
  folds.decided = true;
  return folds;
}

}  // namespace facula
