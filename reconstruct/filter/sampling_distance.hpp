// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/point_cloud.hpp>
#include <facula/reconstruct/filter/nearest_neighbours.hpp>

namespace facula {

/// How far apart a scanner's samples lie on a surface: medians over the points [m].
struct SamplingDistance {
  double nearest = 0;  ///< to the nearest point: along the stripe
  double across = 0;   ///< to the nearest point seen from elsewhere: from stripe to stripe
};

/// A line scanner samples its stripe densely and steps coarsely from stripe to stripe; what joins
/// points (pieces of planes, edges of meshes) must reach across the coarser of the two. Stripes are
/// told apart by their sensor origins; where all points share one, `across` equals `nearest`. Zeros
/// for clouds of fewer than two finite points.
SamplingDistance sampling_distance(const PointCloud& cloud);

/// The same where the tree of the cloud's points is there already.
SamplingDistance sampling_distance(const PointCloud& cloud, const NearestNeighbours& tree);

/// Voxel that evens out a cloud sampled more than three times as coarsely from stripe to stripe as
/// along the stripe: half the coarse step [m]. 0 where the cloud is even enough as it is.
double evening_voxel(const PointCloud& cloud);

/// The same where the tree of the cloud's points is there already.
double evening_voxel(const PointCloud& cloud, const NearestNeighbours& tree);

}  // namespace facula
