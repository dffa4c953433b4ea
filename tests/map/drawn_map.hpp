// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/map/occupancy_map.hpp>

#include <array>
#include <map>

namespace facula {

/// A box of cells: low inclusive, high exclusive, counted from the cell that begins at 0 m.
struct DrawnBox {
  std::array<int, 3> low;
  std::array<int, 3> high;
};

/// A map painted cell by cell; what is not painted is unknown.
class DrawnMap {
 public:
  static constexpr float kFree = -2.0F;  ///< log-odds
  static constexpr float kOccupied = 3.5F;

  explicit DrawnMap(double resolution) : resolution_(resolution) {}

  void paint(const DrawnBox& box, float log_odds) {
    for (int z = box.low[2]; z < box.high[2]; ++z) {
      for (int y = box.low[1]; y < box.high[1]; ++y) {
        for (int x = box.low[0]; x < box.high[0]; ++x) {
          const CellKey key = {x + kCentreKey, y + kCentreKey, z + kCentreKey};
          Brick& brick = bricks_[brick_code(key)];
          brick.values[cell_in_brick(key)] = log_odds;
          brick.known.set(cell_in_brick(key));
        }
      }
    }
  }
  void free(const DrawnBox& box) { paint(box, kFree); }
  void occupy(const DrawnBox& box) { paint(box, kOccupied); }

  /// Free inside, with walls, floor and ceiling one cell thick around the box.
  void room(const DrawnBox& inside) {
    const auto& [low, high] = inside;
    occupy({{low[0] - 1, low[1] - 1, low[2] - 1}, {high[0] + 1, high[1] + 1, high[2] + 1}});
    free(inside);
  }

  /// The inside of the box becomes unknown again.
  void forget(const DrawnBox& box) {
    for (int z = box.low[2]; z < box.high[2]; ++z) {
      for (int y = box.low[1]; y < box.high[1]; ++y) {
        for (int x = box.low[0]; x < box.high[0]; ++x) {
          const CellKey key = {x + kCentreKey, y + kCentreKey, z + kCentreKey};
          const std::size_t cell = cell_in_brick(key);
          bricks_[brick_code(key)].known.words[cell >> 6] &= ~(std::uint64_t{1} << (cell & 63));
        }
      }
    }
  }

  OccupancyMap map() const {
    OccupancyMap map({.resolution = resolution_});
    for (const auto& [code, brick] : bricks_) {
      map.bricks().find_or_add(code).assign(brick.values, brick.known);
    }
    return map;
  }

 private:
  struct Brick {
    LogOddsBrick::Values values{};
    CellMask known;
  };
  double resolution_;
  std::map<std::uint64_t, Brick> bricks_;
};

}  // namespace facula
