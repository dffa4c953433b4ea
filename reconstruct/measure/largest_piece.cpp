// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/disjoint_sets.hpp>
#include <facula/acquire/core/error.hpp>
#include <facula/reconstruct/measure/largest_piece.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <Eigen/Geometry>

namespace facula {
namespace {

using CellKey = std::uint64_t;

constexpr std::uint64_t kRow = std::uint64_t{1} << 32;

/// The cell of a place on the plane: rows in the upper half, so that sorted keys run row by row.
CellKey key_of(double u, double v) {
  const auto step = [](double s) {
    return static_cast<std::uint64_t>(std::clamp(std::floor(s), -2e9, 2e9) + 2147483648.0);
  };
  return step(u) * kRow + step(v);
}

/// Groups of cells that touch, corners included.
class CellGroups {
 public:
  explicit CellGroups(const std::vector<CellKey>& key_of_point) : cells_(key_of_point) {
    std::sort(cells_.begin(), cells_.end());
    cells_.erase(std::unique(cells_.begin(), cells_.end()), cells_.end());
    sets_ = DisjointSets(cells_.size());
    join_neighbours();
  }

  std::size_t group_of(CellKey key) {
    const auto cell = std::lower_bound(cells_.begin(), cells_.end(), key);
    return sets_.find(static_cast<std::uint32_t>(cell - cells_.begin()));
  }

  std::size_t cells() const { return cells_.size(); }

 private:
  /// The cell beside it in its row and the three next to it in the following row.
  void join_neighbours() {
    const auto count = static_cast<std::uint32_t>(cells_.size());
    std::uint32_t next_row = 0;
    for (std::uint32_t i = 0; i < count; ++i) {
      if (i + 1 < count && cells_[i + 1] == cells_[i] + 1) sets_.join(i, i + 1);
      const CellKey first = cells_[i] + kRow - 1;
      while (next_row < count && cells_[next_row] < first) ++next_row;
      for (std::uint32_t k = next_row; k < count && cells_[k] <= first + 2; ++k) sets_.join(i, k);
    }
  }

  std::vector<CellKey> cells_;
  DisjointSets sets_{0};
};

}  // namespace

std::vector<std::size_t> largest_piece(const PointCloud& cloud,
                                       const std::vector<std::size_t>& indices,
                                       const Plane& plane,
                                       double cell) {
  require(cell > 0, "the cell of a piece is ", cell, " m; give a length above 0");
  const Eigen::Vector3d axis_u = plane.normal.unitOrthogonal() / cell;
  const Eigen::Vector3d axis_v = plane.normal.cross(axis_u);
  std::vector<CellKey> keys;
  keys.reserve(indices.size());
  for (const std::size_t i : indices) {
    const Eigen::Vector3d x = cloud.points[i].cast<double>();
    keys.push_back(key_of(x.dot(axis_u), x.dot(axis_v)));
  }
  CellGroups groups(keys);
  std::vector<std::size_t> group(indices.size());
  std::vector<std::size_t> points(groups.cells(), 0);
  for (std::size_t n = 0; n < indices.size(); ++n) {
    group[n] = groups.group_of(keys[n]);
    ++points[group[n]];
  }
  const auto largest =
      static_cast<std::size_t>(std::max_element(points.begin(), points.end()) - points.begin());
  std::vector<std::size_t> piece;
  for (std::size_t n = 0; n < indices.size(); ++n) {
    if (group[n] == largest) piece.push_back(indices[n]);
  }
  return piece;
}

}  // namespace facula
