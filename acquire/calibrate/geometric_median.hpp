// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <Eigen/Core>

namespace facula {

/// The point with the smallest weighted sum of distances to the votes (Weiszfeld's algorithm): up
/// to half of the weight may lie anywhere. Votes of one dimension, at least one; weights above 0.
Eigen::VectorXd geometric_median(const std::vector<Eigen::VectorXd>& votes,
                                 const std::vector<double>& weights);

}  // namespace facula
