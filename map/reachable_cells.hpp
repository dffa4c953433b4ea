// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/map/clearance.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace facula {

/// The cells of a box that a ball can get into from one of them, passing from cell to cell through
/// faces where some place in either may be far enough from obstacles (Clearance::may_hold()). No
/// way of the ball leads out of these cells; that one leads into each of them is not certain.
class ReachableCells {
 public:
  /// None when the ball cannot even be in the first cell.
  ReachableCells(const Clearance& clearance,
                 const CellBox& box,
                 const CellKey& first,
                 double radius,
                 int num_threads = 0);

  std::size_t size() const { return below_.back(); }  ///< [1]
  bool contains(const CellKey& cell) const;

  /// The cells by number, below size().
  CellKey operator[](std::size_t number) const;

 private:
  std::size_t row_of(const CellKey& cell) const;
  void fill(const std::vector<std::uint64_t>& passable);
  bool fill_row(const std::vector<std::uint64_t>& passable, std::size_t row);

  CellBox box_;
  std::size_t words_;                 // per row along x
  std::vector<std::uint64_t> cells_;  // rows in the order y, z
  std::vector<std::size_t> below_;    // cells in all words before this one
};

}  // namespace facula
