// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/parallel.hpp>
#include <facula/tests/bench/filter_peers_pcl.hpp>

#include <cmath>

#include <pcl/features/normal_3d_omp.h>
#include <pcl/filters/statistical_outlier_removal.h>
#include <pcl/filters/voxel_grid.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>
#include <pcl/search/kdtree.h>

namespace facula {

using Points = pcl::PointCloud<pcl::PointXYZ>;
using Tree = pcl::search::KdTree<pcl::PointXYZ>;

struct PclCloud::Impl {
  Points::Ptr points = std::make_shared<Points>();
};

PclCloud::PclCloud(const PointCloud& cloud) : impl_(std::make_unique<Impl>()) {
  for (const Eigen::Vector3f& p : cloud.points) impl_->points->emplace_back(p.x(), p.y(), p.z());
}
PclCloud::~PclCloud() = default;

std::size_t PclCloud::statistical_inliers(int neighbours, double max_ratio) const {
  pcl::StatisticalOutlierRemoval<pcl::PointXYZ> filter;
  filter.setInputCloud(impl_->points);
  filter.setMeanK(neighbours);
  filter.setStddevMulThresh(max_ratio);
  pcl::Indices kept;
  filter.filter(kept);
  return kept.size();
}

std::size_t PclCloud::statistical_inliers_threads(int neighbours,
                                                  double max_ratio,
                                                  int threads) const {
  Tree tree;
  tree.setInputCloud(impl_->points);
  std::vector<double> mean(impl_->points->size());
  const auto measure = [&](std::size_t begin, std::size_t end) {
    pcl::Indices found;
    std::vector<float> squared;
    for (std::size_t i = begin; i < end; ++i) {
      tree.nearestKSearch((*impl_->points)[i], neighbours + 1, found, squared);
      for (const float s : squared) mean[i] += std::sqrt(s) / neighbours;
    }
  };
  parallel_for(mean.size(), measure, {.num_threads = threads, .chunk = 1024});
  double sum = 0;
  double squares = 0;
  for (const double m : mean) {
    sum += m;
    squares += m * m;
  }
  const double n = static_cast<double>(mean.size());
  const double limit = sum / n + max_ratio * std::sqrt((squares - sum * sum / n) / (n - 1));
  std::size_t kept = 0;
  for (const double m : mean) kept += m <= limit ? 1 : 0;
  return kept;
}

std::size_t PclCloud::normals(int neighbours, int threads) const {
  pcl::NormalEstimationOMP<pcl::PointXYZ, pcl::Normal> estimation(
      static_cast<unsigned int>(threads));
  estimation.setInputCloud(impl_->points);
  estimation.setSearchMethod(std::make_shared<Tree>());
  estimation.setKSearch(neighbours);
  pcl::PointCloud<pcl::Normal> normals;
  estimation.compute(normals);
  return normals.size();
}

std::size_t PclCloud::thinned(float voxel) const {
  pcl::VoxelGrid<pcl::PointXYZ> filter;
  filter.setInputCloud(impl_->points);
  filter.setLeafSize(voxel, voxel, voxel);
  Points thinned;
  filter.filter(thinned);
  return thinned.size();
}

}  // namespace facula
