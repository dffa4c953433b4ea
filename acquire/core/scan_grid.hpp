// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/polar_scan.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace facula {

/// Which point of a cloud stands in which cell of the grid it was scanned in. Cells are stored
/// column by column, as in PolarScan: cell (row, col) stands at index col * rows + row.
struct ScanGrid {
  static constexpr std::int32_t kNone = -1;

  int rows = 0;
  int cols = 0;
  std::vector<std::int32_t> point;  ///< index of the cell's point in its cloud, or kNone [1]

  bool empty() const { return point.empty(); }
  std::size_t index(int row, int col) const {
    return static_cast<std::size_t>(col) * static_cast<std::size_t>(rows) +
           static_cast<std::size_t>(row);
  }

  /// Throws Error when the cells do not fit rows and cols, or name a point that is not there or
  /// that another cell names too.
  void check(std::size_t points) const;
};

/// The grid of cloud_from_scan(scan): its points in the same order.
ScanGrid grid_from_scan(const PolarScan& scan);

/// The grid of the points that are kept: `kept` holds their old indices in the new order.
ScanGrid selected(const ScanGrid& grid, const std::vector<std::size_t>& kept);

}  // namespace facula
