// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/stripe/line_kernels.hpp>
#include <facula/acquire/stripe/stripe_signal.hpp>

#include <vector>

namespace facula {

/// A place in a row that looks like a bright line, to a pixel or two.
struct RowPeak {
  int column = 0;      ///< [px]
  float response = 0;  ///< of the curvature filter [DN/px^2]
};

/// The line-like places of one row, and what else is in the row beside the strongest.
struct LocatedRow {
  std::vector<RowPeak> peaks;  ///< strongest first, none nearer to another than 2 sigma
  float row_noise = 0;         ///< grain, compression, texture: robust, as the filter sees it [DN]
};

/// The up to `max_peaks` strongest maxima of the curvature of the smoothed row between columns
/// [begin, end): a line bends there, a broad bright surface does not.
LocatedRow locate_in_row(
    const SignalRow& row, const LineKernels& kernels, int begin, int end, int max_peaks);

}  // namespace facula
