// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

namespace facula {

/// What a list of errors amounts to; all values of its absolute size.
struct ErrorStatistics {
  std::size_t count = 0;
  double mean = 0;
  double rms = 0;
  double percentile_99 = 0;
  double largest = 0;
};

/// NaN counts as no measurement and is left out. All zero for an empty list.
ErrorStatistics statistics_of(const std::vector<double>& errors);

}  // namespace facula
