// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/parallel.hpp>
#include <facula/reconstruct/filter/nearest_neighbours.hpp>
#include <facula/reconstruct/filter/outlier_filters.hpp>

#include <array>
#include <cmath>

namespace facula {

void RadiusFilterOptions::check() const {
  require(radius > 0 && std::isfinite(radius), "radius is ", radius, " m; give a length above 0");
  require(min_neighbours >= 1, "min_neighbours is ", min_neighbours, "; give at least 1");
  require(num_threads >= 0, "num_threads is ", num_threads, "; give 0 (all cores) or more");
}

FilterVerdict radius_outliers(const PointCloud& cloud, const RadiusFilterOptions& options) {
  options.check();
  cloud.check();
  FilterVerdict verdict(cloud.size());
  const NearestNeighbours tree(cloud.points, options.num_threads);
  const auto limit = static_cast<float>(options.radius * options.radius);
  std::vector<char> lonely(cloud.size(), 1);
  if (tree.size() > static_cast<std::size_t>(options.min_neighbours)) {
    // Is the min_neighbours-th other point within the radius? No need to see the others.
    const auto judge = [&](std::size_t i, std::span<const NearestNeighbours::Neighbour> found) {
      float farthest = 0;
      for (const auto& neighbour : found) farthest = std::max(farthest, neighbour.squared_distance);
      lonely[i] = farthest > limit ? 1 : 0;
    };
    tree.for_all_nearest(options.min_neighbours + 1, judge, options.num_threads);
  }
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (!cloud.points[i].allFinite()) verdict.remove(i, Removal::kNotFinite);
    if (lonely[i] != 0) verdict.remove(i, Removal::kRadius);
  }
  return verdict;
}

}  // namespace facula
