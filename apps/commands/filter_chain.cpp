// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/apps/commands/filter_chain.hpp>
#include <facula/reconstruct/filter/grid_normals.hpp>
#include <facula/reconstruct/filter/normals.hpp>

namespace facula {
namespace {

/// From the grid where there is one, else by neighbours.
void add_normals(GriddedCloud& points, int num_threads) {
  if (!points.cloud.normals.empty() || points.cloud.empty()) return;
  if (points.grid.empty()) {
    estimate_normals(points.cloud, {.num_threads = num_threads});
  } else {
    GridNormalOptions options;
    options.num_threads = num_threads;
    points.cloud.normals = grid_normals(points.cloud, points.grid, options);
  }
}

}  // namespace

FilterVerdict run_filters(GriddedCloud& points, const PolarScan* scan, const FilterChain& chain) {
  FilterVerdict all(points.cloud.size());
  const auto follow = [&](const FilterVerdict& next) {
    add_verdict(all, next);
    apply(points, next);
  };
  if (chain.mixed && scan != nullptr) follow(mixed_points(*scan, chain.mixed_options));
  if (chain.range) follow(outside_range(points.cloud, *chain.range));
  if (chain.height) follow(outside_height(points.cloud, *chain.height, chain.world_from_scan));
  if (chain.max_incidence) {
    add_normals(points, chain.num_threads);
    follow(steeper_than(points.cloud, *chain.max_incidence));
  }
  if (chain.statistical) follow(statistical_outliers(points.cloud, *chain.statistical));
  if (chain.radius) follow(radius_outliers(points.cloud, *chain.radius));
  return all;
}

}  // namespace facula
