// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/stripe/line_kernels.hpp>
#include <facula/acquire/stripe/stripe_signal.hpp>

#include <vector>

namespace facula {

/// A place in a row that looks like a bright line, to about half a pixel.
struct RowPeak {
  int column = 0;      ///< [px]
  float response = 0;  ///< what a pair of columns in the line exceeds its surroundings by, over the
                       ///< standard deviation that noise of 1 DN gives to that: about the line's
                       ///< height over the surroundings [DN]
};

/// The line-like places of one row, and what else is in the row beside the strongest.
struct LocatedRow {
  std::vector<RowPeak> peaks;  ///< strongest first, none nearer to another than 2 sigma
  float row_noise = 0;         ///< grain, compression, texture: robust, as the search sees it; 0
                               ///< where it is below 1.5 DN [DN]
};

/// The up to `max_peaks` places between columns [begin, end) that stand out the most over both
/// sides: a line does, a broad bright surface and its edges do not.
LocatedRow locate_in_row(
    const SignalRow& row, const LineKernels& kernels, int begin, int end, int max_peaks);

}  // namespace facula
