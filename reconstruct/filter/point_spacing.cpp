// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/reconstruct/filter/nearest_neighbours.hpp>
#include <facula/reconstruct/filter/point_spacing.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace facula {

std::vector<float> point_spacing(const std::vector<Eigen::Vector3f>& points) {
  const NearestNeighbours tree(points);
  std::vector<float> spacing(points.size(), std::numeric_limits<float>::quiet_NaN());
  const auto measure = [&](std::size_t i, std::span<const NearestNeighbours::Neighbour> found) {
    float squared = 0;  // of the two, the point itself is at 0
    for (const auto& neighbour : found) squared = std::max(squared, neighbour.squared_distance);
    if (found.size() == 2) spacing[i] = std::sqrt(squared);
  };
  tree.for_all_nearest(2, measure);
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
