// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/map/ray_walk.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace facula {
namespace {

constexpr int kCentreKey = VoxelBricks::kKeyLimit / 2;

/// Length as OctoMap takes it: summed in float from left to right, root in double.
double length_of(const Eigen::Vector3f& v) {
  const float squared = v.x() * v.x() + v.y() * v.y() + v.z() * v.z();
  return std::sqrt(static_cast<double>(squared));
}

/// One axis of a walk.
struct AxisWalk {
  double next = std::numeric_limits<double>::max();   ///< ray parameter at the next border [m]
  double delta = std::numeric_limits<double>::max();  ///< from border to border [m]
  std::uint64_t step = 0;                             ///< what a step adds to the key
};

AxisWalk start_axis(double resolution, int key, float origin, float along) {
  AxisWalk axis;
  if (!(along > 0) && !(along < 0)) return axis;
  const int sign = along > 0 ? 1 : -1;
  double border = (static_cast<double>(key - kCentreKey) + 0.5) * resolution;
  border += static_cast<float>(sign * resolution * 0.5);
  axis.next = (border - static_cast<double>(origin)) / static_cast<double>(along);
  axis.delta = resolution / std::fabs(static_cast<double>(along));
  axis.step = static_cast<std::uint64_t>(static_cast<std::int64_t>(sign));
  return axis;
}

/// A ray within the grid, in units of metres along it.
struct Ray {
  Eigen::Vector3f origin;
  Eigen::Vector3f direction;
  double length;
};

/// Marks the cells from `first` up to but without `last`. The axis with the nearest border steps;
/// ties go to the later axis. Written without branches on the axis: which one it is cannot be
/// foreseen, and a wrong guess by the processor costs more than the step.
void mark_between(const VoxelGrid& grid,
                  const Ray& ray,
                  const CellKey& first,
                  const CellKey& last,
                  VoxelBricks& cells) {
  const auto axis = [&](int i) {
    const int key = first[static_cast<std::size_t>(i)];
    return start_axis(grid.resolution, key, ray.origin[i], ray.direction[i]);
  };
  AxisWalk x = axis(0);
  AxisWalk y = axis(1);
  AxisWalk z = axis(2);
  const std::uint64_t step_y = y.step << PackedCell::kShift;
  const std::uint64_t step_z = z.step << 2 * PackedCell::kShift;
  const std::uint64_t end = PackedCell::of(last).bits;
  PackedCell cell = PackedCell::of(first);
  VoxelBrick* brick = &cells.brick_of(cell);
  brick->passed[cell.word()] |= cell.bit();
  for (;;) {
    const bool x_before_y = x.next < y.next;
    const double nearer = x_before_y ? x.next : y.next;
    const bool take_z = z.next <= nearer;
    const bool take_x = x_before_y && !take_z;
    const bool take_y = !x_before_y && !take_z;
    const std::uint64_t before = cell.brick();
    cell.bits += take_z ? step_z : x_before_y ? x.step : step_y;
    x.next += take_x ? x.delta : 0.0;
    y.next += take_y ? y.delta : 0.0;
    z.next += take_z ? z.delta : 0.0;
    // Rounding can lead past the last cell; the ray's length then ends the walk.
    const double reached = std::min(std::min(x.next, y.next), z.next);
    if (cell.bits == end || reached > ray.length) return;
    if (cell.brick() != before) {
      if ((cell.bits & PackedCell::kOffGrid) != 0) return;
      brick = &cells.brick_of(cell);
    }
    brick->passed[cell.word()] |= cell.bit();
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
    if (length > 0) mark_between(grid, {origin, way / length, length}, *first, *last, cells);
  }
  if (!cut) cells.mark_ended(PackedCell::of(*last));
  return true;
}

}  // namespace facula
