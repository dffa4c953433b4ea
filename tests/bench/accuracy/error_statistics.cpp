// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/tests/bench/accuracy/error_statistics.hpp>

#include <algorithm>
#include <cmath>

namespace facula {

ErrorStatistics statistics_of(const std::vector<double>& errors) {
  std::vector<double> sizes;
  ErrorStatistics s;
  for (const double error : errors) {
    if (std::isnan(error)) continue;
    sizes.push_back(std::abs(error));
    s.mean += std::abs(error);
    s.rms += error * error;
  }
  s.count = sizes.size();
  if (sizes.empty()) return s;
  const auto n = static_cast<double>(sizes.size());
  s.mean /= n;
  s.rms = std::sqrt(s.rms / n);
  std::sort(sizes.begin(), sizes.end());
  s.percentile_99 = sizes[static_cast<std::size_t>(0.99 * (n - 1))];
  s.largest = sizes.back();
  return s;
}

}  // namespace facula
