// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/reconstruct/measure/largest_piece.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <utility>

namespace facula {
namespace {

using CellKey = std::uint64_t;

CellKey key_of(std::int64_t u, std::int64_t v) {
  return (static_cast<CellKey>(static_cast<std::uint32_t>(u)) << 32) |
         static_cast<std::uint32_t>(v);
}

std::pair<std::int64_t, std::int64_t> cell_of(CellKey key) {
  return {static_cast<std::int32_t>(key >> 32), static_cast<std::int32_t>(key & 0xffffffffU)};
}

/// Two unit vectors that span the plane.
std::array<Eigen::Vector3d, 2> axes_of(const Plane& plane) {
  const Eigen::Vector3d u = plane.normal.unitOrthogonal();
  return {u, plane.normal.cross(u)};
}

/// Numbers the connected groups of cells; returns the number of the one with most points.
class CellGroups {
 public:
  explicit CellGroups(const std::vector<CellKey>& key_of_point) {
    for (const CellKey key : key_of_point) ++cells_[key].points;
    std::size_t most = 0;
    for (const CellKey key : key_of_point) {  // in the order of the points: the same every time
      if (cells_[key].group != 0) continue;
      const std::size_t points = fill(key, ++groups_);
      if (points <= most) continue;
      most = points;
      largest_ = groups_;
    }
  }

  bool in_largest(CellKey key) const { return cells_.at(key).group == largest_; }

 private:
  struct Cell {
    std::size_t points = 0;
    std::size_t group = 0;
  };

  std::size_t fill(CellKey start, std::size_t group) {
    std::vector<CellKey> open{start};
    cells_[start].group = group;
    std::size_t points = 0;
    while (!open.empty()) {
      const CellKey key = open.back();
      open.pop_back();
      points += cells_[key].points;
      const auto [u, v] = cell_of(key);
      for (int i = 0; i < 9; ++i) {
        const auto next = cells_.find(key_of(u + i / 3 - 1, v + i % 3 - 1));
        if (next == cells_.end() || next->second.group != 0) continue;
        next->second.group = group;
        open.push_back(next->first);
      }
    }
    return points;
  }

  std::unordered_map<CellKey, Cell> cells_;
  std::size_t groups_ = 0;
  std::size_t largest_ = 0;
};

}  // namespace

std::vector<std::size_t> largest_piece(const PointCloud& cloud,
                                       const std::vector<std::size_t>& indices,
                                       const Plane& plane,
                                       double cell) {
  require(cell > 0, "the cell of a piece is ", cell, " m; give a length above 0");
  const auto [axis_u, axis_v] = axes_of(plane);
  std::vector<CellKey> keys;
  keys.reserve(indices.size());
  for (const std::size_t i : indices) {
    const Eigen::Vector3d x = cloud.points[i].cast<double>();
    const auto step = [cell](double s) {
      return static_cast<std::int64_t>(std::clamp(std::floor(s / cell), -2e9, 2e9));
    };
    keys.push_back(key_of(step(x.dot(axis_u)), step(x.dot(axis_v))));
  }
  const CellGroups groups(keys);
  std::vector<std::size_t> piece;
  for (std::size_t n = 0; n < indices.size(); ++n) {
    if (groups.in_largest(keys[n])) piece.push_back(indices[n]);
  }
  return piece;
}

}  // namespace facula
