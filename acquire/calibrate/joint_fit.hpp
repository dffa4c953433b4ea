// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/calibrate/joint_model.hpp>
#include <facula/acquire/calibrate/joint_solver.hpp>

#include <cstddef>
#include <string>
#include <vector>

namespace facula {

/// Names of the rig parameters that a set of sights is asked to decide.
std::vector<std::string> joint_parameters(const Rig& rig,
                                          const std::vector<JointSight>& sights,
                                          const JointOptions& options);

/// Everything free and every sight taking part, the scales as given.
JointFreedom full_freedom(const JointState& state,
                          const std::vector<JointSight>& sights,
                          const JointOptions& options,
                          const std::vector<bool>& scales);

/// Marks gross errors by a robust fit, then least squares on the rest, in turns until the marks
/// stay. Noise that is not given is estimated along the way. Replaces state, marks and noise.
JointSolution fit_robustly(const JointFreedom& freedom,
                           const JointOptions& options,
                           std::vector<JointSight>& sights,
                           JointNoise& noise,
                           JointState& state);

/// The fit without each part of the views in turn.
struct JointFolds {
  bool decided = false;            ///< whether every part could be held out
  std::string reason;              ///< why not
  std::vector<JointState> states;  ///< per fold: the rig of the other views, poses of the held out
  std::vector<std::size_t> fold_of_sight;
  Eigen::MatrixXd changes;  ///< of the rig parameters against the full fit, a column per fold
};
JointFolds hold_out(const JointFreedom& freedom,
                    const JointOptions& options,
                    const std::vector<JointSight>& sights,
                    const JointNoise& noise,
                    const JointState& state);

}  // namespace facula
