// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/map/ray_walk.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

namespace facula {
namespace {

constexpr int kCentreKey = VoxelBricks::kKeyLimit / 2;

/// Length as OctoMap takes it: summed in float from left to right, root in double.
double length_of(const Eigen::Vector3f& v) {
  const float squared = v.x() * v.x() + v.y() * v.y() + v.z() * v.z();
  return std::sqrt(static_cast<double>(squared));
}

/// State of a walk. next[i] is the ray parameter [m] at which it enters the next cell along axis i.
struct Walk {
  CellKey cell;
  int step[3];
  double next[3];
  double delta[3];
};

Walk start_walk(const VoxelGrid& grid,
                const CellKey& cell,
                const Eigen::Vector3f& origin,
                const Eigen::Vector3f& direction) {
  Walk walk{cell, {0, 0, 0}, {}, {}};
  for (int i = 0; i < 3; ++i) {
    const float along = direction[i];
    walk.next[i] = walk.delta[i] = std::numeric_limits<double>::max();
    if (!(along > 0) && !(along < 0)) continue;
    walk.step[i] = along > 0 ? 1 : -1;
    const int key = cell[static_cast<std::size_t>(i)];
    double border = (static_cast<double>(key - kCentreKey) + 0.5) * grid.resolution;
    border += static_cast<float>(walk.step[i] * grid.resolution * 0.5);
    walk.next[i] = (border - static_cast<double>(origin[i])) / static_cast<double>(along);
    walk.delta[i] = grid.resolution / std::fabs(static_cast<double>(along));
  }
  return walk;
}

/// Axis of the nearest border; ties go to the later axis.
std::size_t nearest_axis(const Walk& walk) {
  const std::size_t xy = walk.next[0] < walk.next[1] ? 0 : 1;
  return walk.next[xy] < walk.next[2] ? xy : 2;
}

void mark_passed(VoxelBrick& brick, const CellKey& cell) {
  const unsigned bit = VoxelBricks::bit_of(cell);
  brick.passed[bit >> 6] |= std::uint64_t{1} << (bit & 63);
}

/// Marks the cells from `first` up to but without `last`.
void mark_between(Walk walk, const CellKey& last, double length, VoxelBricks& cells) {
  VoxelBrick* brick = &cells.brick_of(walk.cell);
  mark_passed(*brick, walk.cell);
  for (;;) {
    const std::size_t axis = nearest_axis(walk);
    const int before = walk.cell[axis];
    const int after = before + walk.step[axis];
    walk.cell[axis] = after;
    walk.next[axis] += walk.delta[axis];
    // Rounding can lead past the last cell; the ray's length then ends the walk.
    const double reached = std::min(std::min(walk.next[0], walk.next[1]), walk.next[2]);
    if (walk.cell == last || reached > length) return;
    if (after < 0 || after >= VoxelBricks::kKeyLimit) return;
    if (((before ^ after) & ~7) != 0) brick = &cells.brick_of(walk.cell);
    mark_passed(*brick, walk.cell);
  }
}

}  // namespace

std::optional<CellKey> VoxelGrid::cell_of(const Eigen::Vector3f& x) const {
  const double cells_per_metre = 1.0 / resolution;
  CellKey cell;
  for (int i = 0; i < 3; ++i) {
    const double index = std::floor(cells_per_metre * static_cast<double>(x[i]));
    if (!(index >= -kCentreKey && index < kCentreKey)) return std::nullopt;  // catches NaN too
    cell[static_cast<std::size_t>(i)] = static_cast<int>(index) + kCentreKey;
  }
  return cell;
}

bool walk_ray(const VoxelGrid& grid,
              const Eigen::Vector3f& origin,
              const Eigen::Vector3f& end,
              VoxelBricks& cells) {
  if (!end.allFinite()) return false;
  const double range = length_of(end - origin);
  const bool cut = grid.max_range > 0 && range > grid.max_range;
  Eigen::Vector3f target = end;
  if (cut) {
    const Eigen::Vector3f unit = (end - origin) / static_cast<float>(range);
    target = origin + unit * static_cast<float>(grid.max_range);
  }
  const auto first = grid.cell_of(origin);
  const auto last = grid.cell_of(target);
  if (!first || !last) return false;
  if (*first != *last) {
    const Eigen::Vector3f way = target - origin;
    const auto length = static_cast<float>(length_of(way));
    if (length > 0) {
      mark_between(start_walk(grid, *first, origin, way / length), *last, length, cells);
    }
  }
  if (!cut) cells.mark_ended(*last);
  return true;
}

}  // namespace facula
