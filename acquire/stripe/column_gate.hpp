// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

namespace facula {

/// The columns of every row in which a stripe can be at all (rows and columns change places for a
/// stripe that runs per column). Empty: anywhere.
struct ColumnGate {
  std::vector<std::int32_t> first;  ///< first column per row [px]
  std::vector<std::int32_t> end;    ///< one past the last column; not above first: none [px]

  bool empty() const { return first.empty(); }
};

}  // namespace facula
