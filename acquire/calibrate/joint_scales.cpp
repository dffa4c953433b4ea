// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/calibrate/joint_scales.hpp>

#include <cmath>
#include <sstream>

namespace facula {
namespace {

constexpr double kUndecided = 0.02;      // sigma of a scale above which nothing ties the board [1]
constexpr double kConflictSigmas = 3;    // [1]
constexpr double kLeastConflict = 1e-4;  // smaller than any board is cut or printed [1]

/// What the fit with free sizes says of each board.
std::vector<BoardScale> judge_scales(const JointFreedom& freedom,
                                     const JointSolution& solution,
                                     const JointState& state) {
  std::vector<BoardScale> scales;
  auto column = static_cast<Eigen::Index>(freedom.rig_parameters.size());
  for (std::size_t b = 1; b < state.scales.size(); ++b) {
    BoardScale scale;
    scale.board = b;
    if (freedom.scales[b] && solution.covariance.size() > 0) {
      scale.factor = state.scales[b];
      scale.sigma = std::sqrt(solution.covariance(column, column));
      scale.decided = scale.sigma < kUndecided;
      const double off = std::abs(scale.factor - 1);
      scale.conflict = scale.decided && off > kConflictSigmas * scale.sigma && off > kLeastConflict;
    }
    if (freedom.scales[b]) ++column;
    scales.push_back(scale);
  }
  return scales;
}

}  // namespace

ScaledFit fit_with_scales(const JointOptions& options,
                          std::vector<JointSight>& sights,
                          JointNoise& noise,
                          JointState& state) {
  std::vector<bool> free(state.scales.size(), false);
  for (const JointSight& sight : sights) free[sight.board] = sight.board > 0;
  ScaledFit fit;
  fit.freedom = full_freedom(state, sights, options, free);
  const JointState start = state;
  fit.solution = fit_robustly(fit.freedom, options, sights, noise, state);
  fit.scales = judge_scales(fit.freedom, fit.solution, state);
  bool any_fixed = false;
  for (const BoardScale& scale : fit.scales) {
    any_fixed = any_fixed || (free[scale.board] && !scale.conflict);
    free[scale.board] = scale.conflict;
  }
  if (!any_fixed) return fit;
  for (const BoardScale& scale : fit.scales) {
    if (!scale.conflict) state.scales[scale.board] = 1;
  }
  fit.freedom = full_freedom(state, sights, options, free);
  fit.solution = fit_robustly(fit.freedom, options, sights, noise, state);
  return fit;
}

std::string scale_sentence(const BoardScale& scale) {
  std::ostringstream text;
  text.precision(4);
  if (scale.conflict) {
    text << "the sizes of the boards contradict: board " << scale.board + 1 << " measures "
         << scale.factor << " +- " << scale.sigma
         << " times what it is said to, if board 1 is right; the shape is as good as the rest, the "
            "absolute size is known to "
         << 100 * std::abs(scale.factor - 1)
         << " % only: measure the boards with calipers and put the right one first";
  } else if (!scale.decided) {
    text << "nothing compares the size of board " << scale.board + 1
         << " with board 1: show the laser line on both, or both on the axis";
  }
  return text.str();
}

}  // namespace facula
