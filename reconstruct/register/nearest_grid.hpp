// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace facula {

/// Nearest points looked up instead of searched for: a sparse grid whose cells near the points name
/// the point nearest to the cell's centre. Good to half a cell's diagonal, which is what rough
/// poses need, in some ten nanoseconds a query.
class NearestGrid {
 public:
  static constexpr std::int32_t kNone = -1;

  NearestGrid() = default;

  /// Cells of edge length `cell` [m]; those within `reach` [m] of a point are filled. Points that
  /// are not finite or beyond 2^20 cells from the origin are left out.
  NearestGrid(const std::vector<Eigen::Vector3f>& points, double cell, double reach);

  /// Index of the point near x, or kNone where none is within reach.
  std::int32_t near(const Eigen::Vector3f& x) const {
    const std::uint64_t key = key_of(x);
    if (key == kEmpty || entries_.empty()) return kNone;
    for (std::size_t slot = hash(key) & mask_;; slot = (slot + 1) & mask_) {
      if (entries_[slot].key == key) return entries_[slot].point;
      if (entries_[slot].key == kEmpty) return kNone;
    }
  }

 private:
  static constexpr std::uint64_t kEmpty = ~std::uint64_t{0};
  static constexpr float kHalf = 1 << 20;  // cells on either side of the origin

  struct Entry {
    std::uint64_t key = kEmpty;
    float distance = 0;  // of the point from the cell's centre, squared, in cells
    std::int32_t point = kNone;
  };

  static std::uint64_t hash(std::uint64_t key) {
    key *= 0x9E3779B97F4A7C15ULL;
    return key ^ (key >> 29);
  }

  std::uint64_t key_of(const Eigen::Vector3f& x) const {
    const Eigen::Array3f c = x.array() * per_cell_ + kHalf;
    // NaN fails these comparisons too.
    if (!(c.minCoeff() >= 2 && c.maxCoeff() < 2 * kHalf - 2)) return kEmpty;
    return (static_cast<std::uint64_t>(c.x()) << 42) | (static_cast<std::uint64_t>(c.y()) << 21) |
           static_cast<std::uint64_t>(c.z());
  }

  void offer(std::uint64_t key, float distance, std::int32_t point);
  void grow();

  float per_cell_ = 1;
  std::size_t mask_ = 0;
  std::size_t used_ = 0;
  std::vector<Entry> entries_;
};

}  // namespace facula
