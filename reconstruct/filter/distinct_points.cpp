// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/reconstruct/filter/distinct_points.hpp>

#include <algorithm>
#include <tuple>

namespace facula {

std::vector<std::size_t> distinct_points(const std::vector<Eigen::Vector3f>& points) {
  std::vector<std::size_t> indices;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i].allFinite()) indices.push_back(i);
  }
  const auto place = [&](std::size_t i) {
    return std::make_tuple(points[i].x(), points[i].y(), points[i].z());
  };
  std::sort(indices.begin(), indices.end(), [&](std::size_t a, std::size_t b) {
    return std::make_tuple(place(a), a) < std::make_tuple(place(b), b);
  });
  const auto last = std::unique(indices.begin(), indices.end(), [&](std::size_t a, std::size_t b) {
    return points[a] == points[b];
  });
  indices.erase(last, indices.end());
  std::sort(indices.begin(), indices.end());
  return indices;
}

}  // namespace facula
