// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/map/cell_box.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace facula {

/// One bit per cell of a box, set where the cell is an obstacle. Rows run along x and begin at a
/// border of bricks, so that eight cells of a brick's row are one byte.
class ObstacleBits {
 public:
  /// Occupied cells of the map, and with kOccupied the unknown ones too; the same for any number of
  /// threads.
  ObstacleBits(const OccupancyMap& map, const CellBox& box, UnknownCells unknown, int num_threads);

  const CellBox& box() const { return box_; }

  /// Cells of row (y, z), counted from the box's corner, from x to at least x + 56: bit i stands
  /// for x + i. Bits behind the row's end mean nothing.
  std::uint64_t from(std::size_t row, int x) const;

  /// Rows are numbered along y, then z.
  std::size_t rows() const;

  static std::size_t memory_needed(const CellBox& box);  ///< [bytes]

 private:
  CellBox box_;
  int skipped_ = 0;            // cells between the first brick's border and the box
  std::size_t row_bytes_ = 0;  // with padding for reads of eight bytes
  std::vector<std::uint8_t> bytes_;
};

}  // namespace facula
