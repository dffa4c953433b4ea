// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/parallel.hpp>
#include <facula/reconstruct/measure/convex_hull_3d.hpp>
#include <facula/reconstruct/measure/convex_hull_filter.hpp>
#include <facula/reconstruct/measure/principal_frame.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include <Eigen/Geometry>

namespace facula {
namespace {

using Index = std::uint32_t;
using Points = std::vector<Eigen::Vector3d>;

constexpr std::size_t kWorthwhile = 2000;  // below, the hull itself is as quick
constexpr std::size_t kChunk = 16384;
constexpr int kCells = 32;  // along either axis
constexpr int kSides = 8;   // directions along which the cloud's rim is sought
constexpr Index kNone = std::numeric_limits<Index>::max();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The points that stick out farthest in each cell and along each side: the hull of these lies
/// within the hull of all.
struct Extremes {
  std::array<Index, 2 * kCells * kCells + kSides> point{};
  std::array<double, 2 * kCells * kCells + kSides> height{};

  Extremes() {
    point.fill(kNone);
    height.fill(-kInfinity);
  }
  void offer(std::size_t place, Index i, double value) {
    if (value <= height[place]) return;
    height[place] = value;
    point[place] = i;
  }
};

int cell_along(double x, double low, double size) {
  return std::clamp(static_cast<int>((x - low) / size), 0, kCells - 1);
}

class CellFilter {
 public:
  CellFilter(const Points& points, int num_threads)
      : points_(points), parallel_{.num_threads = num_threads, .chunk = kChunk} {
    frame_ = principal_frame(points, num_threads);
    local_.resize(points.size());
    const auto turn = [&](std::size_t begin, std::size_t end) {
      Eigen::AlignedBox3d box;
      for (std::size_t i = begin; i < end; ++i) {
        local_[i] = frame_.local(points_[i]);
        box.extend(local_[i]);
      }
      return box;
    };
    box_ = parallel_reduce(
        points.size(),
        Eigen::AlignedBox3d(),
        turn,
        [](const Eigen::AlignedBox3d& a, const Eigen::AlignedBox3d& b) { return a.merged(b); },
        parallel_);
    low_ = box_.min().head<2>();
    size_ = (box_.sizes().head<2>() / kCells).cwiseMax(1e-300);
  }

  std::vector<Index> outer_points() {
    bound_cells(convex_hull_of_extremes());
    const auto collect = [&](std::size_t begin, std::size_t end) {
      std::vector<Index> part;
      for (std::size_t i = begin; i < end; ++i) {
        const std::size_t cell = cell_of(local_[i]);
        const double w = local_[i].z();
        if (!(w > floor_[cell] && w < ceiling_[cell])) part.push_back(static_cast<Index>(i));
      }
      return part;
    };
    const auto join = [](std::vector<Index> a, const std::vector<Index>& b) {
      a.insert(a.end(), b.begin(), b.end());
      return a;
    };
    return parallel_reduce(points_.size(), std::vector<Index>{}, collect, join, parallel_);
  }

 private:
  std::size_t cell_of(const Eigen::Vector3d& at) const {
    const int col = cell_along(at.x(), low_.x(), size_.x());
    const int row = cell_along(at.y(), low_.y(), size_.y());
    return static_cast<std::size_t>(row * kCells + col);
  }

  Points convex_hull_of_extremes() const {
    std::array<Eigen::Vector2d, kSides> sides;
    for (int k = 0; k < kSides; ++k) {
      const double angle = 2 * 3.14159265358979323846 * k / kSides;
      sides[static_cast<std::size_t>(k)] = {std::cos(angle), std::sin(angle)};
    }
    constexpr std::size_t kCellCount = static_cast<std::size_t>(kCells) * kCells;
    const auto map = [&](std::size_t begin, std::size_t end) {
      Extremes part;
      for (std::size_t i = begin; i < end; ++i) {
        const std::size_t cell = cell_of(local_[i]);
        const auto index = static_cast<Index>(i);
        part.offer(cell, index, local_[i].z());
        part.offer(kCellCount + cell, index, -local_[i].z());
        for (std::size_t k = 0; k < kSides; ++k) {
          part.offer(2 * kCellCount + k, index, sides[k].dot(local_[i].head<2>()));
        }
      }
      return part;
    };
    const auto combine = [](Extremes a, const Extremes& b) {
      for (std::size_t k = 0; k < b.point.size(); ++k) a.offer(k, b.point[k], b.height[k]);
      return a;
    };
    const Extremes all = parallel_reduce(points_.size(), Extremes{}, map, combine, parallel_);
    Points result;
    for (const Index i : all.point) {
      if (i != kNone) result.push_back(local_[i]);
    }
    return result;
  }

  /// The box over a cell from floor to ceiling lies inside the inner hull: its eight corners do,
  /// with a margin far above the rounding of the turned points. Empty where there is none.
  void bound_cells(const Points& extremes) {
    const ConvexHull hull = convex_hull_3d(extremes);
    constexpr int kGrid = kCells + 1;
    std::vector<double> least(kGrid * kGrid, hull.dimension == 3 ? -kInfinity : kInfinity);
    std::vector<double> most(kGrid * kGrid, hull.dimension == 3 ? kInfinity : -kInfinity);
    const double size = box_.sizes().norm();
    for (const auto& [a, b, c] : hull.faces) {
      const Eigen::Vector3d u = extremes[b] - extremes[a];
      const Eigen::Vector3d v = extremes[c] - extremes[a];
      const double length = u.cross(v).norm();
      if (!(length > 0)) return;
      const Eigen::Vector3d n = u.cross(v) / length;
      // The normal of a needle of a face is less certain than the turned points are.
      const double margin = size * (1e-13 + 1e-15 * u.norm() * v.norm() / length);
      const double d = n.dot(extremes[a]) - margin;
      for (int k = 0; k < kGrid * kGrid; ++k) {
        const auto corner = static_cast<std::size_t>(k);
        const int column = k % kGrid;
        const int row = k / kGrid;
        const double rest =
            d - n.x() * (low_.x() + column * size_.x()) - n.y() * (low_.y() + row * size_.y());
        if (n.z() > 0) most[corner] = std::min(most[corner], rest / n.z());
        if (n.z() < 0) least[corner] = std::max(least[corner], rest / n.z());
        if (n.z() == 0 && rest < 0) most[corner] = -kInfinity;
      }
    }
    for (int row = 0; row < kCells; ++row) {
      for (int col = 0; col < kCells; ++col) {
        const auto cell = static_cast<std::size_t>(row * kCells + col);
        floor_[cell] = -kInfinity;
        ceiling_[cell] = kInfinity;
        for (const int k : {row * kGrid + col,
                            row * kGrid + col + 1,
                            (row + 1) * kGrid + col,
                            (row + 1) * kGrid + col + 1}) {
          floor_[cell] = std::max(floor_[cell], least[static_cast<std::size_t>(k)]);
          ceiling_[cell] = std::min(ceiling_[cell], most[static_cast<std::size_t>(k)]);
        }
      }
    }
  }

  const Points& points_;
  ParallelOptions parallel_;
  PrincipalFrame frame_;
  Eigen::AlignedBox3d box_;
  Points local_;
  Eigen::Vector2d low_;
  Eigen::Vector2d size_;
  std::array<double, static_cast<std::size_t>(kCells) * kCells> floor_{};
  std::array<double, static_cast<std::size_t>(kCells) * kCells> ceiling_{};
};

}  // namespace

std::vector<Index> hull_candidates(const Points& points, int num_threads) {
  if (points.size() < kWorthwhile) {
    for (const Eigen::Vector3d& x : points) {
      require(x.allFinite(),
              "expected finite points, got coordinates that are not; filter them out first");
    }
    std::vector<Index> all(points.size());
    std::iota(all.begin(), all.end(), Index{0});
    return all;
  }
  return CellFilter(points, num_threads).outer_points();
}

}  // namespace facula
