// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/map/brick_index.hpp>
#include <facula/map/ray_walk.hpp>
#include <facula/map/weigh_hits.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace facula {
namespace {

/// The surest point of every cell of a brick, in eighths; 0 where none ended.
using Eighths = std::array<std::uint8_t, kCellsPerBrick>;

std::vector<Eighths> surest(const PointCloud& cloud,
                            const CastOptions& options,
                            const BrickIndex& index) {
  std::vector<Eighths> result(index.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const CellRay ray =
        make_ray(cloud.sensor_origin[i], cloud.points[i], options.resolution, options.max_range);
    if (!ray.first || !ray.last || ray.cut) continue;
    const std::size_t place = index.find(brick_code(*ray.last));
    if (place == BrickIndex::kNone) continue;
    std::uint8_t& best = result[place][cell_in_brick(*ray.last)];
    best = std::max(best, sure_eighths(cloud.sigma[i], options.resolution));
  }
  return result;
}

}  // namespace

std::uint8_t sure_eighths(float sigma, double resolution) {
  if (!std::isfinite(sigma) || sigma <= 0) return ScanBrick::kSure;
  const double share = std::erf(resolution / (2 * std::numbers::sqrt2 * sigma));
  return static_cast<std::uint8_t>(std::clamp(std::lround(8 * share), 1L, 8L));
}

void weigh_hits(const PointCloud& cloud, const CastOptions& options, ScanCells& cells) {
  if (cloud.sigma.empty()) return;
  BrickIndex index;
  bool added = false;
  for (const ScanBrick& brick : cells.bricks) {
    if (!brick.ended.none()) index.find_or_add(brick.code, index.size(), &added);
  }
  const std::vector<Eighths> eighths = surest(cloud, options, index);
  std::vector<ScanBrick> weighed;
  for (const ScanBrick& brick : cells.bricks) {
    std::array<CellMask, ScanBrick::kSure + 1> of;  // cells by their eighths
    const std::size_t place = index.find(brick.code);
    for_each_cell(brick.ended, [&](std::size_t cell) { of[eighths[place][cell]].set(cell); });
    weighed.push_back({brick.code, brick.passed, of[ScanBrick::kSure] | of[0]});
    for (std::uint8_t e = ScanBrick::kSure - 1; e > 0; --e) {
      if (!of[e].none()) weighed.push_back({brick.code, {}, of[e], e});
    }
  }
  cells.bricks = std::move(weighed);
}

}  // namespace facula
