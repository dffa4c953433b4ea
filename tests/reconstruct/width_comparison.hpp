// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace facula {

/// width_of() against judged_width() on the first clouds of width_cloud().
struct WidthComparison {
  unsigned judged = 0;       ///< clouds that fill space [1]
  unsigned flat = 0;         ///< clouds that lie in one plane, which the judge cannot take [1]
  double worst = 0;          ///< largest relative difference from the judge [1]
  bool flat_is_zero = true;  ///< all flat clouds have a width of exactly 0
};

WidthComparison compare_widths(unsigned clouds);

}  // namespace facula
