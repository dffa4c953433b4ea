// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/stripe/stripe_detector.hpp>

#include <algorithm>

namespace facula {

/// Rows [first, last) and, within a row, columns [begin, end) that are searched.
struct SearchArea {
  int first = 0;  ///< [px]
  int last = 0;   ///< [px]
  int begin = 0;  ///< [px]
  int end = 0;    ///< [px]
};

/// The options' region on a signal of so many rows and columns (transposed where the stripe runs
/// per column).
inline SearchArea search_area(int rows, int cols, const StripeOptions& options) {
  const bool transposed = options.direction == StripeDirection::kPerColumn;
  const ImageRegion& region = options.region;
  const int first = transposed ? region.x : region.y;
  const int begin = transposed ? region.y : region.x;
  const int high = transposed ? region.width : region.height;
  const int wide = transposed ? region.height : region.width;
  SearchArea area;
  area.first = std::clamp(first, 0, rows);
  area.last = high > 0 && high < rows - area.first ? area.first + high : rows;
  area.begin = std::clamp(begin, 0, cols);
  area.end = wide > 0 && wide < cols - area.begin ? area.begin + wide : cols;
  return area;
}

}  // namespace facula
