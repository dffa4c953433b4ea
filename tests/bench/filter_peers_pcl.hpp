// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/point_cloud.hpp>

#include <cstddef>
#include <memory>

namespace facula {

/// PCL's filters over a cloud that is PCL's already. Each builds its own search tree, as ours do,
/// and returns how many points it kept or made.
class PclCloud {
 public:
  explicit PclCloud(const PointCloud& cloud);
  ~PclCloud();

  /// pcl::StatisticalOutlierRemoval: one thread.
  std::size_t statistical_inliers(int neighbours, double max_ratio) const;

  /// The same over pcl::search::KdTree with its queries shared out to threads.
  std::size_t statistical_inliers_threads(int neighbours, double max_ratio, int threads) const;

  /// pcl::NormalEstimationOMP.
  std::size_t normals(int neighbours, int threads) const;

  /// pcl::VoxelGrid, edge length [m].
  std::size_t thinned(float voxel) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace facula
