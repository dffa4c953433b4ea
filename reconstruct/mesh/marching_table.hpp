// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace facula {

/// An edge of a cell: along `axis` from corner `from` (bit 0 = x, bit 1 = y, bit 2 = z).
struct CellEdge {
  int axis = 0;
  int from = 0;
};

/// The twelve edges of a cell.
const std::array<CellEdge, 12>& cell_edges();

/// Triangles of a cell whose corners below zero are the bits of `inside`, as triples of edges,
/// counter-clockwise seen from the corners above zero (Lorensen and Cline 1987). On a face with two
/// opposite corners inside they are always kept apart, and no triangle has a side across a face
/// that is not a side of the cell's outline there: neighbouring cells fit for all signs.
const std::vector<std::array<std::uint8_t, 3>>& cell_triangles(std::uint8_t inside);

}  // namespace facula
