// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/reconstruct/measure/plane.hpp>
#include <facula/reconstruct/measure/plane_pool.hpp>

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>

#include <Eigen/Eigenvalues>

namespace facula {
namespace {

constexpr int kWindow = 1;          // cells to every side that are neighbours [1]
constexpr int kFailures = 30;       // regions in a row that are no planes end the search
constexpr double kSharpest = 0.35;  // between the normals of a seed and its neighbours [rad]
constexpr std::uint8_t kTaken = 1;

/// Sums over the points of a region, from which its plane follows without looking at them again.
struct Region {
  Eigen::Vector3d base = Eigen::Vector3d::Zero();
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  double count = 0;

  void add(const Eigen::Vector3d& x) {
    const Eigen::Vector3d d = x - base;
    sum += d;
    squares += d * d.transpose();
    ++count;
  }

  Plane plane() const {
    const Eigen::Matrix3d scatter = squares - sum * sum.transpose() / count;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(scatter);
    const Eigen::Vector3d normal = solver.eigenvectors().col(0).normalized();
    return {normal, normal.dot(base + sum / count)};
  }
};

/// The grid with what a region needs to know of its cells.
class Field {
 public:
  Field(const PointCloud& cloud, const ScanGrid& grid) : cloud_(cloud), grid_(grid) {
    taken_.assign(grid.point.size(), 0);
  }

  /// Calls visit(cell) for every neighbour of a cell that holds a point.
  template <typename Visit>
  void for_neighbours(std::size_t cell, const Visit& visit) const {
    const auto rows = static_cast<std::size_t>(grid_.rows);
    const int row = static_cast<int>(cell % rows);
    const int col = static_cast<int>(cell / rows);
    for (int c = std::max(0, col - kWindow); c <= std::min(grid_.cols - 1, col + kWindow); ++c) {
      for (int r = std::max(0, row - kWindow); r <= std::min(grid_.rows - 1, row + kWindow); ++r) {
        const std::size_t next = grid_.index(r, c);
        if (next != cell && grid_.point[next] != ScanGrid::kNone) visit(next);
      }
    }
  }

  std::size_t point(std::size_t cell) const { return static_cast<std::size_t>(grid_.point[cell]); }
  Eigen::Vector3d place(std::size_t cell) const {
    return cloud_.points[point(cell)].cast<double>();
  }
  Eigen::Vector3d normal(std::size_t cell) const {
    return cloud_.normals[point(cell)].cast<double>();
  }

  /// Cells from the flattest place on: by the largest angle to a neighbour's normal. Cells at edges
  /// and without a whole neighbourhood begin no region.
  std::vector<std::size_t> seeds() const {
    std::vector<std::pair<float, std::size_t>> order;
    for (std::size_t cell = 0; cell < grid_.point.size(); ++cell) {
      if (grid_.point[cell] == ScanGrid::kNone || !place(cell).allFinite()) continue;
      double least = 1;
      int neighbours = 0;
      for_neighbours(cell, [&](std::size_t next) {
        least = std::min(least, normal(cell).dot(normal(next)));
        ++neighbours;
      });
      if (neighbours < 6 || !(least > std::cos(kSharpest))) continue;
      order.emplace_back(static_cast<float>(1 - least), cell);
    }
    std::sort(order.begin(), order.end());
    std::vector<std::size_t> cells;
    cells.reserve(order.size());
    for (const auto& [roughness, cell] : order) cells.push_back(cell);
    return cells;
  }

  bool taken(std::size_t cell) const { return taken_[cell] != 0; }

  /// The region around a seed: cells whose points lie on the region's plane and whose normals agree
  /// with it. The plane is fitted anew whenever the region has doubled.
  Plane grow(std::size_t seed, const PlanePool& pool, double max_normal_angle) {
    Region region{place(seed)};
    Plane plane{normal(seed).normalized(), normal(seed).normalized().dot(place(seed))};
    const double min_cosine = std::cos(max_normal_angle);
    double fitted_at = 32;
    std::deque<std::size_t> open{seed};
    taken_[seed] = kTaken;
    while (!open.empty()) {
      const std::size_t cell = open.front();
      open.pop_front();
      region.add(place(cell));
      if (region.count >= fitted_at) {
        plane = region.plane();
        fitted_at *= 2;
      }
      for_neighbours(cell, [&](std::size_t next) {
        if (taken_[next] != 0) return;
        const double away = std::abs(plane.signed_distance(place(next)));
        if (!(away <= pool.reach_of(point(next), plane.normal))) return;
        if (!(std::abs(plane.normal.dot(normal(next))) >= min_cosine)) return;
        taken_[next] = kTaken;
        open.push_back(next);
      });
    }
    size_ = static_cast<std::size_t>(region.count);
    return size_ >= 3 ? region.plane() : plane;
  }

  /// Cells of the region grown last.
  std::size_t size() const { return size_; }

  /// Takes the cells of all points out that are not in `left`, which ascends.
  void keep_only(const std::vector<std::size_t>& left) {
    for (std::size_t cell = 0; cell < grid_.point.size(); ++cell) {
      if (grid_.point[cell] == ScanGrid::kNone) continue;
      if (!std::binary_search(left.begin(), left.end(), point(cell))) taken_[cell] = kTaken;
    }
  }

 private:
  const PointCloud& cloud_;
  const ScanGrid& grid_;
  std::vector<std::uint8_t> taken_;
  std::size_t size_ = 0;
};

}  // namespace

std::vector<ExtractedPlane> grow_planes(const PointCloud& cloud,
                                        const ScanGrid& grid,
                                        const PlaneExtractionOptions& options) {
  options.check();
  cloud.check();
  grid.check(cloud.size());
  require(cloud.empty() || !cloud.normals.empty(),
          "growing planes over a grid needs normals, the cloud has none; estimate them first");
  // The flattest places come first, the largest planes not: all are grown, then the largest kept.
  PlaneExtractionOptions all = options;
  all.max_planes = std::numeric_limits<int>::max();
  PlanePool pool(cloud, all);
  Field field(cloud, grid);
  int failures = 0;
  for (const std::size_t seed : field.seeds()) {
    if (pool.full() || failures >= kFailures) break;
    if (field.taken(seed)) continue;
    const Plane plane = field.grow(seed, pool, options.max_normal_angle);
    if (field.size() < options.min_points / 2) continue;
    failures = pool.take(plane) ? 0 : failures + 1;
    field.keep_only(pool.left());
  }
  std::vector<ExtractedPlane> planes = std::move(pool).planes();
  if (planes.size() > static_cast<std::size_t>(options.max_planes)) {
    planes.erase(planes.begin() + options.max_planes, planes.end());
  }
  return planes;
}

}  // namespace facula
