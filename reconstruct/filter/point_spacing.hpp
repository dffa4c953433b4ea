// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include <Eigen/Core>

namespace facula {

/// Distance from every point to the nearest other one [m]; NaN where the point is not finite or
/// stands alone.
std::vector<float> point_spacing(const std::vector<Eigen::Vector3f>& points);

/// The value that `share` [0..1] of the values do not exceed; values that are NaN do not count. 0
/// where there are none.
double quantile(std::vector<float> values, double share);

}  // namespace facula
