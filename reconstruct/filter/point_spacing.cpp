// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/parallel.hpp>
#include <facula/reconstruct/filter/nearest_neighbours.hpp>
#include <facula/reconstruct/filter/point_spacing.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace facula {

std::vector<float> point_spacing(const std::vector<Eigen::Vector3f>& points) {
  const NearestNeighbours tree(points);
  std::vector<float> spacing(points.size(), std::numeric_limits<float>::quiet_NaN());
  const auto measure = [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto nearest = tree.nearest(points[i], 2);
      if (nearest.size() == 2) spacing[i] = std::sqrt(nearest[1].squared_distance);
    }
  };
  parallel_for(points.size(), measure, {.num_threads = 0, .chunk = 1024});
  return spacing;
}

double quantile(std::vector<float> values, double share) {
  std::erase_if(values, [](float v) { return std::isnan(v); });
  if (values.empty()) return 0;
  const double rank = std::clamp(share, 0.0, 1.0) * static_cast<double>(values.size() - 1);
  const auto place = values.begin() + static_cast<std::ptrdiff_t>(rank);
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

}  // namespace facula
