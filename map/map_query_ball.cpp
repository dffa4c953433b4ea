// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/map/brick_box.hpp>
#include <facula/map/map_query.hpp>
#include <facula/map/place_text.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

namespace facula {
namespace {

/// Squared distances along one axis from x to the eight layers of cells from key `first` on.
std::array<double, kBrickEdge> layer_gaps(double x, int first, double resolution) {
  std::array<double, kBrickEdge> gaps{};
  for (int i = 0; i < kBrickEdge; ++i) {
    const double low = (first + i - kCentreKey) * resolution;
    const double gap = std::max({low - x, x - (low + resolution), 0.0});
    gaps[static_cast<std::size_t>(i)] = gap * gap;
  }
  return gaps;
}

/// Looks for the cell nearest to a point.
class NearestSearch {
 public:
  NearestSearch(const Eigen::Vector3d& x, double radius, double resolution)
      : x_(x), resolution_(resolution), best_squared_(radius * radius) {}

  /// `first` is the brick's lowest cell.
  void look_at(const CellKey& first, const CellMask& mask) {
    std::array<std::array<double, kBrickEdge>, 3> gaps{};
    double least = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      gaps[i] = layer_gaps(x_[static_cast<Eigen::Index>(i)], first[i], resolution_);
      least += *std::min_element(gaps[i].begin(), gaps[i].end());
    }
    if (least > best_squared_) return;
    for_each_cell(mask, [&](std::size_t cell) {
      const double squared = gaps[0][cell & 7] + gaps[1][cell >> 3 & 7] + gaps[2][cell >> 6];
      if (squared > best_squared_) return;
      const CellKey key = cell_at(first, cell);
      if (found_ && squared == best_squared_ && !before(key, best_)) return;
      best_ = key;
      best_squared_ = squared;
      found_ = true;
    });
  }

  std::optional<NearCell> result() const {
    if (!found_) return std::nullopt;
    return NearCell{best_, std::sqrt(best_squared_)};
  }

 private:
  static bool before(const CellKey& a, const CellKey& b) {
    return std::tie(a[2], a[1], a[0]) < std::tie(b[2], b[1], b[0]);
  }

  Eigen::Vector3d x_;
  double resolution_;
  double best_squared_;
  CellKey best_{};
  bool found_ = false;
};

/// The cells that a ball may reach into; none when it lies wholly outside of all cells.
std::optional<CellBox> cells_about(const Eigen::Vector3d& x, double radius, double resolution) {
  CellBox box;
  for (std::size_t i = 0; i < 3; ++i) {
    const double at = x[static_cast<Eigen::Index>(i)];
    const double low = std::floor((at - radius) / resolution) - 1;  // -1, +1: rounding
    const double high = std::floor((at + radius) / resolution) + 1;
    if (!(high >= -kCentreKey && low < kCentreKey)) return std::nullopt;
    box.low[i] = static_cast<int>(std::max<double>(low, -kCentreKey)) + kCentreKey;
    box.high[i] = static_cast<int>(std::min<double>(high, kCentreKey - 1)) + kCentreKey;
  }
  return box;
}

/// Whether no cell lies farther away, so that larger balls find nothing more.
bool covers_space(const Eigen::Vector3d& x, double radius, double resolution) {
  const double reach = kCentreKey * resolution;
  return x.cwiseAbs().maxCoeff() + reach <= radius / std::sqrt(3.0);
}

}  // namespace

std::optional<NearCell> MapQuery::nearest_within(const Eigen::Vector3d& x,
                                                 double radius,
                                                 UnknownCells unknown) const {
  auto box = cells_about(x, radius, resolution_);
  if (box && unknown != UnknownCells::kOccupied) {
    box = known_ ? common_cells(*box, *known_) : std::nullopt;
  }
  if (!box) return std::nullopt;
  NearestSearch search(x, radius, resolution_);
  any_brick(bricks_of(*box), [&](const CellKey& brick) {
    const Brick& cells = find(first_of(brick));
    const CellMask mask =
        unknown == UnknownCells::kOccupied ? ~cells.known | cells.occupied : cells.occupied;
    if (!mask.none()) search.look_at(first_of(brick), mask);
    return false;
  });
  return search.result();
}

std::optional<NearCell> MapQuery::nearest_obstacle(const Eigen::Vector3d& x,
                                                   double radius,
                                                   UnknownCells unknown) const {
  require(std::isfinite(radius) && radius >= 0,
          "expected a ball's radius of 0 m or more, got ",
          radius);
  // Not require(): it would write its sentence for every ball.
  if (!x.allFinite()) fail("expected a ball about a finite point, got ", place_text(x), " m");
  // Balls of growing size: what the first one that finds anything finds is the nearest.
  for (double size = 0.5 * kBrickEdge * resolution_; size < radius; size *= 2) {
    const auto found = nearest_within(x, size, unknown);
    if (found) return found;
    if (covers_space(x, size, resolution_)) return std::nullopt;
  }
  return nearest_within(x, radius, unknown);
}

}  // namespace facula
