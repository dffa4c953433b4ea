// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/apps/commands/deviation_figures.hpp>

#include <limits>

namespace facula {
namespace {

constexpr double kUnbounded = std::numeric_limits<double>::quiet_NaN();  // printed as -

}  // namespace

void report_deviations(const Deviations& deviations, Figures& figures) {
  const DeviationStatistics s = deviation_statistics(deviations.values);
  figures.count("count", "points compared", s.count);
  figures.count("too_far", "points too far away", deviations.too_far);
  if (deviations.beyond_rim > 0) {
    figures.count("beyond_rim", "points beyond the rim", deviations.beyond_rim);
  }
  figures.flag("has_sign", "signed", deviations.has_sign);
  if (s.count == 0) return;
  if (!deviations.has_sign) {
    figures.note(
        "The reference's points have no surface of their own, so these are distances to its "
        "nearest point, which its spacing enlarges.");
  }
  if (deviations.has_sign) {
    figures.number("mean_mm", "mean", 1000 * s.mean, 4);
    figures.number("standard_deviation_mm", "standard deviation", 1000 * s.standard_deviation, 4);
    figures.number("signed_median_mm", "median", 1000 * s.median, 4);
    figures.number("least_mm", "least", 1000 * s.least, 4);
    figures.number("most_mm", "most", 1000 * s.most, 4);
  }
  figures.number("median_mm", "median distance", 1000 * s.median_absolute, 4);
  figures.number("rms_mm", "rms", 1000 * s.rms, 4);
  figures.number("p95_mm", "95 of 100 below", 1000 * s.p95_absolute, 4);
  figures.number("max_mm", "largest", 1000 * s.max_absolute, 4);
}

FigureTable deviation_table(const Deviations& deviations) {
  constexpr std::size_t kBins = 20;
  const DeviationBins bins = bin_deviations(deviations.values, kBins);
  FigureTable table{"histogram",
                    "Deviations:",
                    {{"from_mm", "from", 4}, {"to_mm", "to", 4}, {"points", "points", 0}},
                    {}};
  const double size = (bins.high - bins.low) / static_cast<double>(kBins);
  if (bins.below > 0) {
    table.rows.push_back({kUnbounded, 1000 * bins.low, static_cast<long long>(bins.below)});
  }
  const std::size_t filled = size > 0 ? bins.counts.size() : 1;  // one bin holds what is all alike
  for (std::size_t i = 0; i < filled; ++i) {
    const double from = bins.low + size * static_cast<double>(i);
    table.rows.push_back(
        {1000 * from, 1000 * (from + size), static_cast<long long>(bins.counts[i])});
  }
  if (bins.above > 0) {
    table.rows.push_back({1000 * bins.high, kUnbounded, static_cast<long long>(bins.above)});
  }
  return table;
}

}  // namespace facula
