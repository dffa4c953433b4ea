// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace facula {

/// The median of any number of values above 0 in fixed memory: they are counted in bins whose width
/// is a thousandth of their value. Values below 1e-9 or above 1e9 count as these.
class BinnedMedian {
 public:
  BinnedMedian();
  void add(float value);

  /// To within a thousandth of its value; 0 for none.
  double value() const;

 private:
  std::vector<std::uint32_t> counts_;
  std::size_t total_ = 0;
};

}  // namespace facula
