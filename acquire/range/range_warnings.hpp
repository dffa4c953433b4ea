// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/range/range_fit.hpp>

#include <string>
#include <vector>

namespace facula {

/// What the points of a fit cannot decide: a third parameter within two of its own standard
/// deviations of 0, a slope known worse than 1 %, distances that span less than a factor of 2, a
/// point whose absence changes everything, a point that the others contradict. One sentence each.
std::vector<std::string> range_warnings(const std::vector<RangePoint>& points, const RangeFit& fit);

}  // namespace facula
