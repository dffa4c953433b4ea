// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/point_cloud.hpp>

namespace facula {

struct NormalOptions {
  int neighbours = 20;  ///< points of the local plane [1], at least 3
  int num_threads = 0;  ///< 0 = all cores [1]

  void check() const;
};

/// Sets cloud.normals: least eigenvector of the neighbours' covariance, turned towards the point's
/// sensor origin (towards the frame's origin where there is none). Where the cloud is much denser
/// along the stripe than from stripe to stripe, the neighbours come from the cloud evened out
/// (evening_voxel()): those of one stripe lie on a line and hold no normal.
/// Neighbours stand in places of their own: copies of a point count once.
void estimate_normals(PointCloud& cloud, const NormalOptions& options = {});

}  // namespace facula
