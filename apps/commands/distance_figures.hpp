// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/apps/cli/figures.hpp>

#include <vector>

namespace facula {

/// How a set of lengths or of signed errors is spread.
struct Spread {
  double median = 0;  ///< of the absolute values [m]
  double rms = 0;     ///< [m]
  double p95 = 0;     ///< 95 of 100 absolute values lie at or below [m]
};

/// NaN throughout when there are no values.
Spread spread_of(std::vector<double> values);

/// count, median_mm, rms_mm, p95_mm of distances [m].
void report_distances(const std::vector<double>& distances, Figures& figures);

}  // namespace facula
