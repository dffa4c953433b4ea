// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/polar_scan.hpp>
#include <facula/apps/cli/figures.hpp>

#include <cstddef>
#include <vector>

namespace facula {

/// Errors of a scan's points along the camera's ray, cell by cell against the true scan.
struct RangeErrors {
  std::vector<double> error;       ///< measured minus true [m]
  std::vector<double> normalized;  ///< the same over the point's own sigma [1]
  std::size_t seen = 0;            ///< cells that have a true point and were measured [1]
  std::size_t true_cells = 0;      ///< cells that have a true point [1]
  std::size_t invented = 0;        ///< measured cells without a true point [1]

  void add(const PolarScan& scan, const PolarScan& truth);
};

/// median, rms, p95, bias, reduced chi-square, share beyond 5 sigma and chi-square without it.
void report_range_errors(const RangeErrors& errors, Figures& figures);

}  // namespace facula
