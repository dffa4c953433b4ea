// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/parallel.hpp>
#include <facula/reconstruct/filter/nearest_neighbours.hpp>
#include <facula/reconstruct/filter/point_spacing.hpp>
#include <facula/reconstruct/filter/sampling_distance.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace facula {
namespace {

constexpr std::size_t kSamples = 2000;  // enough for a median to a few per cent

/// Distance to the nearest point with another sensor origin; NaN where none is within reach.
float distance_across(const PointCloud& cloud, const NearestNeighbours& tree, std::size_t i) {
  for (int k = 16; k <= 1024; k *= 4) {
    for (const auto& neighbour : tree.nearest(cloud.points[i], k)) {
      if (cloud.sensor_origin[neighbour.index] != cloud.sensor_origin[i]) {
        return std::sqrt(neighbour.squared_distance);
      }
    }
  }
  return std::numeric_limits<float>::quiet_NaN();
}

bool has_one_origin(const PointCloud& cloud) {
  return cloud.sensor_origin.empty() ||
         std::all_of(cloud.sensor_origin.begin(),
                     cloud.sensor_origin.end(),
                     [&](const Eigen::Vector3f& o) { return o == cloud.sensor_origin.front(); });
}

}  // namespace

SamplingDistance sampling_distance(const PointCloud& cloud) {
  cloud.check();
  if (cloud.size() < 2) return {};
  return sampling_distance(cloud, NearestNeighbours(cloud.points));
}

SamplingDistance sampling_distance(const PointCloud& cloud, const NearestNeighbours& tree) {
  if (cloud.size() < 2) return {};
  const std::size_t samples = std::min(kSamples, cloud.size());
  std::vector<float> nearest(samples, std::numeric_limits<float>::quiet_NaN());
  std::vector<float> across = nearest;
  const bool one_origin = has_one_origin(cloud);
  const auto measure = [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s) {
      const std::size_t i = s * cloud.size() / samples;
      if (!cloud.points[i].allFinite()) continue;
      const auto two = tree.nearest(cloud.points[i], 2);
      if (two.size() == 2) nearest[s] = std::sqrt(two[1].squared_distance);
      if (!one_origin) across[s] = distance_across(cloud, tree, i);
    }
  };
  parallel_for(samples, measure, {.num_threads = 0, .chunk = 64});
  SamplingDistance result;
  result.nearest = quantile(nearest, 0.5);
  result.across = std::max(result.nearest, quantile(across, 0.5));
  return result;
}

double evening_voxel(const PointCloud& cloud) {
  cloud.check();
  return has_one_origin(cloud) ? 0 : evening_voxel(cloud, NearestNeighbours(cloud.points));
}

double evening_voxel(const PointCloud& cloud, const NearestNeighbours& tree) {
  if (has_one_origin(cloud)) return 0;  // stripes cannot be told apart
  const SamplingDistance distance = sampling_distance(cloud, tree);
  return distance.across > 3 * distance.nearest ? distance.across / 2 : 0;
}

}  // namespace facula
