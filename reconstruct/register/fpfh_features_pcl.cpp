// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/parallel.hpp>
#include <facula/reconstruct/pcl_bridge.hpp>
#include <facula/reconstruct/register/fpfh_features.hpp>

#include <cmath>
#include <limits>

#include <pcl/features/fpfh.h>
#include <pcl/search/kdtree.h>

namespace facula {
namespace {

using Estimator = pcl::FPFHEstimation<pcl::PointNormal, pcl::PointNormal, pcl::FPFHSignature33>;

struct Neighbours {
  pcl::Indices indices;
  std::vector<float> squared_distances;
};

/// The points within the radius of every point, the point itself first.
std::vector<Neighbours> neighbourhoods(const pcl::PointCloud<pcl::PointNormal>::Ptr& cloud,
                                       const FpfhOptions& options) {
  pcl::search::KdTree<pcl::PointNormal> tree;
  tree.setInputCloud(cloud);
  std::vector<Neighbours> all(cloud->size());
  const auto search = [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      tree.radiusSearch(
          static_cast<int>(i), options.radius, all[i].indices, all[i].squared_distances);
    }
  };
  parallel_for(cloud->size(), search, {.num_threads = options.num_threads, .chunk = 256});
  return all;
}

}  // namespace

void FpfhOptions::check() const {
  require(radius > 0 && std::isfinite(radius), "radius is ", radius, " m; give a length above 0");
  require(num_threads >= 0, "num_threads is ", num_threads, "; give 0 (all cores) or more");
}

// PCL's own loop runs on one core; its two steps are called here for chunks of points.
std::vector<FpfhFeature> fpfh_features(const PointCloud& cloud, const FpfhOptions& options) {
  options.check();
  std::vector<FpfhFeature> features(cloud.size());
  if (cloud.empty()) return features;
  const auto points = to_pcl_with_normals(cloud);
  require(points->is_dense, "features need finite points; remove the others first");
  const std::vector<Neighbours> near = neighbourhoods(points, options);

  const auto rows = static_cast<Eigen::Index>(cloud.size());
  Eigen::MatrixXf first = Eigen::MatrixXf::Zero(rows, 11);
  Eigen::MatrixXf second = first;
  Eigen::MatrixXf third = first;
  const ParallelOptions share{.num_threads = options.num_threads, .chunk = 128};
  const auto simple = [&](std::size_t begin, std::size_t end) {
    Estimator estimator;
    for (std::size_t i = begin; i < end; ++i) {
      if (near[i].indices.size() < 2) continue;
      const int row = static_cast<int>(i);
      estimator.computePointSPFHSignature(
          *points, *points, row, row, near[i].indices, first, second, third);
    }
  };
  parallel_for(cloud.size(), simple, share);
  const auto weighted = [&](std::size_t begin, std::size_t end) {
    Estimator estimator;
    Eigen::VectorXf histogram(kFpfhBins);
    for (std::size_t i = begin; i < end; ++i) {
      if (near[i].indices.size() < 2) {
        features[i].fill(std::numeric_limits<float>::quiet_NaN());
        continue;
      }
      estimator.weightPointSPFHSignature(
          first, second, third, near[i].indices, near[i].squared_distances, histogram);
      for (int bin = 0; bin < kFpfhBins; ++bin) features[i][bin] = histogram[bin];
    }
  };
  parallel_for(cloud.size(), weighted, share);
  return features;
}

}  // namespace facula
