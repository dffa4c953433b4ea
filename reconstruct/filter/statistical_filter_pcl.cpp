// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/reconstruct/filter/cloud_filters.hpp>
#include <facula/reconstruct/pcl_bridge.hpp>

#include <cmath>

#include <pcl/filters/statistical_outlier_removal.h>

namespace facula {

void StatisticalFilterOptions::check() const {
  require(neighbours >= 1, "neighbours is ", neighbours, "; give at least 1");
  require(max_ratio > 0 && std::isfinite(max_ratio),
          "max_ratio is ",
          max_ratio,
          "; give a number of standard deviations above 0");
}

std::vector<std::size_t> statistical_inliers(const PointCloud& cloud,
                                             const StatisticalFilterOptions& options) {
  options.check();
  cloud.check();
  std::vector<std::size_t> finite;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (cloud.points[i].allFinite()) finite.push_back(i);
  }
  // Fewer points than neighbours have no ordinary distance: nothing can be told apart.
  if (finite.size() <= static_cast<std::size_t>(options.neighbours)) return finite;
  PointCloud positions;
  for (const std::size_t i : finite) positions.points.push_back(cloud.points[i]);
  pcl::StatisticalOutlierRemoval<pcl::PointXYZ> filter;
  filter.setInputCloud(to_pcl(positions));
  filter.setMeanK(options.neighbours);
  filter.setStddevMulThresh(options.max_ratio);
  pcl::Indices kept;
  filter.filter(kept);
  std::vector<std::size_t> inliers;
  inliers.reserve(kept.size());
  for (const int k : kept) inliers.push_back(finite[static_cast<std::size_t>(k)]);
  return inliers;
}

}  // namespace facula
