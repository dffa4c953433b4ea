// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace facula {

/// The value in the middle of the sorted row of values (the upper of the two for an even count), 0
/// for none. Puts the values into another order. They must not be NaN.
template <typename Number>
Number median(std::vector<Number>& values) {
  if (values.empty()) return Number{};
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace facula
