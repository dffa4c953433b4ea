// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/reconstruct/mesh/marching_table.hpp>

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include <gtest/gtest.h>

namespace facula {
namespace {

using Side = std::pair<int, int>;  // of a triangle, from one edge of the cell to another

bool on_face(int edge, int face) {
  const CellEdge& e = cell_edges()[static_cast<std::size_t>(edge)];
  return e.axis != face / 2 && (e.from >> (face / 2) & 1) == face % 2;
}

/// Sides of triangles that no triangle of the same cell has the other way round.
std::set<Side> outline(std::uint8_t inside) {
  std::set<Side> open;
  for (const auto& t : cell_triangles(inside)) {
    for (std::size_t i = 0; i < 3; ++i) {
      const int a = t[i];
      const int b = t[(i + 1) % 3];
      if (open.erase({b, a}) == 0) open.insert({a, b});
    }
  }
  return open;
}

/// The same edge seen from the cell beyond `face`.
int across(int edge, int face) {
  const auto& edges = cell_edges();
  const CellEdge& e = edges[static_cast<std::size_t>(edge)];
  const int from = e.from ^ (1 << face / 2);
  return static_cast<int>(std::find_if(edges.begin(),
                                       edges.end(),
                                       [&](const CellEdge& other) {
                                         return other.axis == e.axis && other.from == from;
                                       }) -
                          edges.begin());
}

TEST(MarchingTable, CrossesTheEdgesWhoseEndsDifferAndNoOther) {
  for (int inside = 0; inside < 256; ++inside) {
    std::set<int> used;
    for (const auto& t : cell_triangles(static_cast<std::uint8_t>(inside))) {
      used.insert(t.begin(), t.end());
    }
    for (int e = 0; e < 12; ++e) {
      const CellEdge& edge = cell_edges()[static_cast<std::size_t>(e)];
      const int to = edge.from | 1 << edge.axis;
      const bool differ = (inside >> edge.from & 1) != (inside >> to & 1);
      ASSERT_EQ(used.count(e) == 1, differ) << "case " << inside << ", edge " << e;
    }
  }
}

TEST(MarchingTable, NeighbouringCellsFitForAllSignsOfTheirTwelveCorners) {
  for (int axis = 0; axis < 3; ++axis) {
    for (unsigned signs = 0; signs < 4096; ++signs) {
      // Bits 0-3 are the near corners of the first cell, 4-7 the shared ones, 8-11 the far ones.
      unsigned first = 0;
      unsigned second = 0;
      unsigned next = 0;
      for (unsigned corner = 0; corner < 8; ++corner) {
        if ((corner >> axis & 1) != 0) continue;
        const unsigned beyond = corner | 1U << axis;
        if ((signs >> next & 1) != 0) first |= 1U << corner;
        if ((signs >> (next + 4) & 1) != 0) first |= 1U << beyond, second |= 1U << corner;
        if ((signs >> (next + 8) & 1) != 0) second |= 1U << beyond;
        ++next;
      }
      std::set<Side> sides;
      for (const Side& s : outline(static_cast<std::uint8_t>(first))) {
        if (on_face(s.first, 2 * axis + 1) && on_face(s.second, 2 * axis + 1)) sides.insert(s);
      }
      std::set<Side> mirrored;
      for (const Side& s : outline(static_cast<std::uint8_t>(second))) {
        if (!on_face(s.first, 2 * axis) || !on_face(s.second, 2 * axis)) continue;
        mirrored.insert({across(s.second, 2 * axis), across(s.first, 2 * axis)});
      }
      ASSERT_EQ(sides, mirrored) << "axis " << axis << ", signs " << signs;
    }
  }
}

TEST(MarchingTable, HasItsOutlineOnTheFacesOnlyAndNoSideAcrossAFaceWithin) {
  for (int inside = 0; inside < 256; ++inside) {
    const std::set<Side> open = outline(static_cast<std::uint8_t>(inside));
    std::map<Side, int> uses;
    for (const auto& t : cell_triangles(static_cast<std::uint8_t>(inside))) {
      for (std::size_t i = 0; i < 3; ++i) {
        ++uses[std::minmax<int>(t[i], t[(i + 1) % 3])];
      }
    }
    for (const auto& [side, count] : uses) {
      bool in_a_face = false;
      for (int face = 0; face < 6; ++face) {
        in_a_face = in_a_face || (on_face(side.first, face) && on_face(side.second, face));
      }
      ASSERT_EQ(count, in_a_face ? 1 : 2) << "case " << inside;
      const bool is_open = open.count(side) + open.count({side.second, side.first}) == 1;
      ASSERT_EQ(is_open, in_a_face) << "case " << inside;
    }
  }
}

TEST(MarchingTable, LooksAwayFromASingleCornerInside) {
  // Corner 0 lies at the cell's origin: the triangle over the middles of its edges must turn its
  // front towards (1, 1, 1).
  const auto& triangles = cell_triangles(1);
  ASSERT_EQ(triangles.size(), 1U);
  std::array<int, 3> axes{};
  for (std::size_t i = 0; i < 3; ++i) axes[i] = cell_edges()[triangles[0][i]].axis;
  // x, y, z in this order (or turned) is counter-clockwise seen from (1, 1, 1).
  EXPECT_EQ((axes[1] - axes[0] + 3) % 3, 1);
  EXPECT_EQ((axes[2] - axes[1] + 3) % 3, 1);
}

}  // namespace
}  // namespace facula
