// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/point_cloud.hpp>
#include <facula/acquire/core/scan_grid.hpp>

namespace facula {

struct GridNormalOptions {
  int neighbours = 24;  ///< cells around a point whose plane is its normal's [1], at least 4
  double max_incidence = 1.45;  ///< steepest angle between ray and surface that joins cells [rad]
  int num_threads = 0;          ///< 0 = all cores [1]

  void check() const;
};

/// Normals straight from the grid a cloud was scanned in: the plane through the cells around each
/// point that hang together with it (no depth edge between them and no hole), turned towards the
/// point's sensor origin (towards the frame's origin where there is none). The window is about
/// square on the surface, whatever the spacing along and across the stripes. A point without three
/// such cells that span a plane looks at the sensor: its normal is the direction to it. Nothing is
/// searched, so this costs a fraction of estimate_normals(). Points outside the grid get no normal
/// (zero).
std::vector<Eigen::Vector3f> grid_normals(const PointCloud& cloud,
                                          const ScanGrid& grid,
                                          const GridNormalOptions& options = {});

}  // namespace facula
