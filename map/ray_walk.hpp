// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/map/cell_grid.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

#include <Eigen/Core>

namespace facula {

/// Length as OctoMap takes it: summed in float from left to right, root in double.
inline double ray_length(const Eigen::Vector3f& v) {
  const float squared = v.x() * v.x() + v.y() * v.y() + v.z() * v.z();
  return std::sqrt(static_cast<double>(squared));
}

/// A ray as it is walked: where it begins and ends after the cut at the maximum range.
struct CellRay {
  Eigen::Vector3f origin;        ///< [m]
  Eigen::Vector3f end;           ///< [m]
  bool cut = false;              ///< it went on: its last cell is no end
  std::optional<CellKey> first;  ///< none outside the grid
  std::optional<CellKey> last;
};

inline CellRay make_ray(const Eigen::Vector3f& origin,
                        const Eigen::Vector3f& end,
                        double resolution,
                        double max_range) {
  CellRay ray{.origin = origin, .end = end, .first = std::nullopt, .last = std::nullopt};
  const double range = ray_length(end - origin);
  ray.cut = max_range > 0 && !(range <= max_range);
  if (ray.cut) {
    const Eigen::Vector3f unit = (end - origin) / static_cast<float>(range);
    ray.end = origin + unit * static_cast<float>(max_range);
  }
  ray.first = cell_of(origin.cast<double>(), resolution);
  ray.last = cell_of(ray.end.cast<double>(), resolution);
  return ray;
}

/// One axis of a walk.
struct AxisWalk {
  double next = std::numeric_limits<double>::max();   ///< ray parameter at the next border [m]
  double delta = std::numeric_limits<double>::max();  ///< from border to border [m]
  int step = 0;                                       ///< what a step adds to the key

  static AxisWalk start(double resolution, int key, float origin, float along) {
    AxisWalk axis;
    if (!(along > 0) && !(along < 0)) return axis;
    axis.step = along > 0 ? 1 : -1;
    double border = (static_cast<double>(key - kCentreKey) + 0.5) * resolution;
    border += static_cast<float>(axis.step * resolution * 0.5);
    axis.next = (border - static_cast<double>(origin)) / static_cast<double>(along);
    axis.delta = resolution / std::fabs(static_cast<double>(along));
    return axis;
  }
};

/// Calls visit(key) for every cell from the ray's first up to but without its last. Walk by
/// Amanatides and Woo (1987), with the roundings, ties and stop rule of OctoMap 1.9.7 (float
/// direction, double parameters advanced by addition), so that the same cells are met: the axis
/// with the nearest border steps, ties go to the later axis, and where rounding leads past the last
/// cell the ray's length ends the walk.
template <typename Visit>
void walk_ray(const CellRay& ray, double resolution, const Visit& visit) {
  if (!ray.first || !ray.last || *ray.first == *ray.last) return;
  const Eigen::Vector3f way = ray.end - ray.origin;
  const auto length = static_cast<float>(ray_length(way));
  if (!(length > 0)) return;
  const Eigen::Vector3f direction = way / length;
  CellKey key = *ray.first;
  std::array<AxisWalk, 3> axes;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto axis = static_cast<Eigen::Index>(i);
    axes[i] = AxisWalk::start(resolution, key[i], ray.origin[axis], direction[axis]);
  }
  for (;;) {
    visit(key);
    const auto& [x, y, z] = axes;
    const std::size_t nearer = x.next < y.next ? 0 : 1;
    const std::size_t axis = axes[nearer].next < z.next ? nearer : 2;
    key[axis] += axes[axis].step;
    axes[axis].next += axes[axis].delta;
    const double reached = std::min(std::min(x.next, y.next), z.next);
    if (key == *ray.last || reached > static_cast<double>(length)) return;
    if (key[axis] < 0 || key[axis] >= kKeyLimit) return;
  }
}

}  // namespace facula
