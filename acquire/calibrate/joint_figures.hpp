// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/calibrate/joint_fit.hpp>

namespace facula {

/// Residuals of every view and over all of them, into the result: of the fit, and where the folds
/// could decide of the views held out.
void fill_figures(const CalibrationSet& set,
                  const std::vector<JointSight>& sights,
                  const JointState& state,
                  const JointFolds& folds,
                  JointCalibration& result);

/// Sigma of the parameters by the folds (delete-a-group jackknife, Quenouille 1949) over that by
/// the covariance, root mean square over the parameters.
double fold_scatter(const JointFolds& folds, const Eigen::MatrixXd& covariance);

}  // namespace facula
