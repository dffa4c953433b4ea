// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/apps/commands/demo/range_error.hpp>
#include <facula/apps/commands/distance_figures.hpp>

#include <cmath>
#include <limits>

namespace facula {
namespace {

constexpr double kFarOut = 5;  // [sigma]

double mean_square(const std::vector<double>& values, double bound) {
  double sum = 0;
  std::size_t count = 0;
  for (const double value : values) {
    if (std::abs(value) > bound) continue;
    sum += value * value;
    ++count;
  }
  return count == 0 ? std::numeric_limits<double>::quiet_NaN() : sum / static_cast<double>(count);
}

double share_beyond(const std::vector<double>& values, double bound) {
  std::size_t count = 0;
  for (const double value : values) count += std::abs(value) > bound ? 1 : 0;
  return values.empty() ? 0 : static_cast<double>(count) / static_cast<double>(values.size());
}

}  // namespace

void RangeErrors::add(const PolarScan& scan, const PolarScan& truth) {
  require(scan.rows == truth.rows && scan.cols == truth.cols,
          "expected a true scan of ",
          scan.rows,
          " x ",
          scan.cols,
          " cells, got ",
          truth.rows,
          " x ",
          truth.cols,
          "; record the capture again");
  for (std::size_t cell = 0; cell < scan.valid.size(); ++cell) {
    if (truth.valid[cell] != 0) ++true_cells;
    if (scan.valid[cell] == 0) continue;
    if (truth.valid[cell] == 0) {
      ++invented;
      continue;
    }
    const auto column = cell / static_cast<std::size_t>(scan.rows);
    const Eigen::Vector3d x_true = truth.point[cell].cast<double>();
    const Eigen::Vector3d ray = (x_true - truth.sensor_origin[column]).normalized();
    const double along = ray.dot(scan.point[cell].cast<double>() - x_true);
    ++seen;
    error.push_back(along);
    normalized.push_back(along / static_cast<double>(scan.sigma[cell]));
  }
}

void report_range_errors(const RangeErrors& errors, Figures& figures) {
  const auto percent = [](std::size_t part, std::size_t whole) {
    return whole == 0 ? 0.0 : 100.0 * static_cast<double>(part) / static_cast<double>(whole);
  };
  double sum = 0;
  for (const double error : errors.error) sum += error;
  const Spread spread = spread_of(errors.error);
  figures.count("cells", "cells compared", errors.seen);
  figures.number(
      "complete_percent", "true cells measured", percent(errors.seen, errors.true_cells), 2);
  figures.count("without_truth", "cells without a true point", errors.invented);
  figures.number("range_error_mean_mm", "range error, mean", 1000 * sum / double(errors.seen), 3);
  figures.number("range_error_median_mm", "range error, median size", 1000 * spread.median, 3);
  figures.number("range_error_rms_mm", "range error, rms", 1000 * spread.rms, 3);
  figures.number("range_error_p95_mm", "range error, 95 of 100 below", 1000 * spread.p95, 3);
  figures.number("reduced_chi2",
                 "reduced chi^2",
                 mean_square(errors.normalized, std::numeric_limits<double>::infinity()),
                 3);
  figures.number("beyond_5_sigma_percent",
                 "beyond 5 sigma",
                 100 * share_beyond(errors.normalized, kFarOut),
                 3);
  figures.number("reduced_chi2_within_5_sigma",
                 "reduced chi^2 of the others",
                 mean_square(errors.normalized, kFarOut),
                 3);
}

}  // namespace facula
