// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/calibrate/joint_model.hpp>

#include <string>
#include <vector>

#include <Eigen/Core>

namespace facula {

struct JointSolution {
  double chi_squared = 0;       ///< of the residuals that took part, robust weights included [1]
  std::size_t residuals = 0;    ///< numbers that took part [1]
  Eigen::VectorXd rig_changes;  ///< in the order and units of the freedom's rig parameters
  std::size_t parameters = 0;   ///< numbers estimated, poses included [1]
  /// Of the rig parameters in the freedom's order, in the units of their names, then of the free
  /// scales. Empty when not asked for, or when a parameter is not determined.
  Eigen::MatrixXd covariance;
  std::string undetermined;  ///< the parameter that the sights cannot decide; empty when all can
};

/// One least squares from `state`, which is replaced by the result (Ceres, Levenberg-Marquardt).
/// With `with_covariance` also the covariance at the result. Throws Error when it cannot start.
JointSolution solve_joint(const std::vector<JointSight>& sights,
                          const JointFreedom& freedom,
                          const JointNoise& noise,
                          bool with_covariance,
                          JointState& state);

}  // namespace facula
