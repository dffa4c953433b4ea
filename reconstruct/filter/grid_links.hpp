// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/point_cloud.hpp>
#include <facula/acquire/core/scan_grid.hpp>

#include <cstdint>
#include <vector>

namespace facula {

/// Which neighbouring cells of a grid lie on one surface. Two cells are joined when the step
/// between their points is not steeper than `max_incidence` [rad] seen from the sensor, or not
/// longer than their sigmas explain (4 standard deviations).
struct GridLinks {
  static constexpr std::uint8_t kDown = 1;   ///< joined to the next row of the column
  static constexpr std::uint8_t kRight = 2;  ///< joined to the same row of the next column

  std::vector<std::uint8_t> joined;  ///< per cell: kDown | kRight
  double row_spacing = 0;            ///< median distance of cells joined down [m]
  double col_spacing = 0;            ///< median distance of cells joined to the right [m]
};

GridLinks grid_links(const PointCloud& cloud,
                     const ScanGrid& grid,
                     double max_incidence,
                     int num_threads = 0);

}  // namespace facula
