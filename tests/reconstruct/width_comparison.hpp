// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace facula {

/// width_of() against judged_width() on the first clouds of width_cloud().
struct WidthComparison {
  unsigned judged = 0;       ///< clouds that fill space [1]
  unsigned flat = 0;         ///< clouds that lie in one plane, which the judge cannot take [1]
  double worst = 0;          ///< largest relative difference from the judge [1]
  std::string worst_kind;    ///< and the kind and number of that cloud
  bool flat_is_zero = true;  ///< all clouds made flat are found so, with a width of exactly 0
};

WidthComparison compare_widths(unsigned clouds);

}  // namespace facula
