// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/map/occupancy_map.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include <Eigen/Core>

namespace facula {

struct CoarseOptions {
  double least_edge = 0.15;  ///< of a coarse cell, as far as 8 cells of the map go [m]
  double margin = 2.0;       ///< unknown space around the known columns that is taken in [m]
};

/// A map in larger cells, in a box. A coarse cell is occupied where any cell in it
/// is, unknown where less than half of them are known, else free.
struct CoarseMap {
  std::array<int, 3> size = {0, 0, 0};               ///< cells along x, y, z [1]
  double edge = 0;                                   ///< of a coarse cell [m]
  Eigen::Vector3d corner = Eigen::Vector3d::Zero();  ///< lower corner of the box, world [m]
  std::vector<CellState> cells;                      ///< x fastest, then y

  std::size_t index(const std::array<int, 3>& cell) const {
    return static_cast<std::size_t>(cell[0]) +
           static_cast<std::size_t>(size[0]) *
               (static_cast<std::size_t>(cell[1]) +
                static_cast<std::size_t>(size[1]) * static_cast<std::size_t>(cell[2]));
  }
  std::array<int, 3> cell_at(std::size_t index) const {
    const auto cols = static_cast<std::size_t>(size[0]);
    const auto rows = static_cast<std::size_t>(size[1]);
    return {static_cast<int>(index % cols),
            static_cast<int>(index / cols % rows),
            static_cast<int>(index / cols / rows)};
  }
  bool holds(const std::array<int, 3>& cell) const {
    return cell[0] >= 0 && cell[0] < size[0] && cell[1] >= 0 && cell[1] < size[1] && cell[2] >= 0 &&
           cell[2] < size[2];
  }
  Eigen::Vector3d centre(std::size_t index) const {
    const auto [x, y, z] = cell_at(index);
    return corner + edge * Eigen::Vector3d(x + 0.5, y + 0.5, z + 0.5);
  }
};

/// Covers what is known, with a margin of unknown to the sides but not above or below. Throws Error
/// for an empty map, and where the box would have more than 2^26 cells.
CoarseMap coarse_map(const OccupancyMap& map, const CoarseOptions& options);

/// Calls visit(index) for the cells along a ray, from the one `origin` [m] lies in to `range` [m]
/// or the border of the box, until it returns false. `direction` is a unit vector. Nothing happens
/// when the origin lies outside. Walk by Amanatides and Woo (1987).
template <typename Visit>
void walk_coarse(const CoarseMap& map,
                 const Eigen::Vector3d& origin,
                 const Eigen::Vector3d& direction,
                 double range,
                 const Visit& visit) {
  std::array<int, 3> cell{};
  std::array<int, 3> left{};               // cells to the border of the box
  std::array<std::ptrdiff_t, 3> stride{};  // what a step adds to the index
  std::array<double, 3> next{};
  std::array<double, 3> delta{};
  std::ptrdiff_t layer = 1;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto axis = static_cast<Eigen::Index>(i);
    const double place = (origin[axis] - map.corner[axis]) / map.edge;
    if (!(place >= 0 && place < map.size[i])) return;
    cell[i] = static_cast<int>(place);
    const double along = direction[axis];
    const double border = along > 0 ? cell[i] + 1 - place : place - cell[i];
    delta[i] = along == 0 ? std::numeric_limits<double>::infinity() : map.edge / std::abs(along);
    next[i] = along == 0 ? delta[i] : border * delta[i];
    left[i] = along > 0 ? map.size[i] - 1 - cell[i] : cell[i];
    stride[i] = along > 0 ? layer : -layer;
    layer *= map.size[i];
  }
  auto index = static_cast<std::ptrdiff_t>(map.index(cell));
  for (;;) {
    if (!visit(static_cast<std::size_t>(index))) return;
    const std::size_t nearer = next[0] < next[1] ? 0 : 1;
    const std::size_t axis = next[nearer] < next[2] ? nearer : 2;
    if (next[axis] > range || left[axis]-- == 0) return;
    index += stride[axis];
    next[axis] += delta[axis];
  }
}

}  // namespace facula
