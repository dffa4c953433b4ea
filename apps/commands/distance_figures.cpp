// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/apps/commands/distance_figures.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace facula {
namespace {

/// The nearest-rank quantile of sorted values.
double quantile(const std::vector<double>& sorted, double share) {
  const auto last = static_cast<double>(sorted.size() - 1);
  return sorted[static_cast<std::size_t>(std::llround(share * last))];
}

}  // namespace

Spread spread_of(std::vector<double> values) {
  constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  if (values.empty()) return {kUnknown, kUnknown, kUnknown};
  double squares = 0;
  for (double& value : values) {
    squares += value * value;
    value = std::abs(value);
  }
  std::sort(values.begin(), values.end());
  return {quantile(values, 0.5),
          std::sqrt(squares / static_cast<double>(values.size())),
          quantile(values, 0.95)};
}

void report_distances(const std::vector<double>& distances, Figures& figures) {
  const Spread spread = spread_of(distances);
  figures.count("count", "points compared", distances.size());
  figures.number("median_mm", "median", 1000 * spread.median, 3);
  figures.number("rms_mm", "rms", 1000 * spread.rms, 3);
  figures.number("p95_mm", "95 of 100 below", 1000 * spread.p95, 3);
}

}  // namespace facula
