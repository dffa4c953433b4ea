// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/reconstruct/mesh/marching_table.hpp>

#include <algorithm>

namespace facula {
namespace {

using Loop = std::vector<int>;  // edges of a cell, one after the other
using CellTriangles = std::vector<std::array<std::uint8_t, 3>>;

constexpr int kNoEdge = -1;
constexpr std::array<CellEdge, 12> kCellEdges{{{0, 0},
                                               {0, 2},
                                               {0, 4},
                                               {0, 6},
                                               {1, 0},
                                               {1, 1},
                                               {1, 4},
                                               {1, 5},
                                               {2, 0},
                                               {2, 1},
                                               {2, 2},
                                               {2, 3}}};

int edge_between(int a, int b) {
  const auto& edges = cell_edges();
  const int from = std::min(a, b);
  const int to = std::max(a, b);
  for (int e = 0; e < 12; ++e) {
    const CellEdge& edge = edges[static_cast<std::size_t>(e)];
    if (edge.from == from && (edge.from | 1 << edge.axis) == to) return e;
  }
  return kNoEdge;
}

/// The corners of face `face` (two per axis), counter-clockwise seen from outside the cell.
std::array<int, 4> face_corners(int face) {
  const int axis = face / 2;
  const int u = 1 << (axis + 1) % 3;
  const int v = 1 << (axis + 2) % 3;
  if (face % 2 == 1) {
    const int far = 1 << axis;
    return {far, far | u, far | u | v, far | v};
  }
  return {0, v, u | v, u};
}

bool on_face(int edge, int face) {
  const CellEdge& e = cell_edges()[static_cast<std::size_t>(edge)];
  const int axis = face / 2;
  return e.axis != axis && (e.from >> axis & 1) == face % 2;
}

bool share_face(int a, int b) {
  for (int face = 0; face < 6; ++face) {
    if (on_face(a, face) && on_face(b, face)) return true;
  }
  return false;
}

/// Where the surface goes on after each crossed edge: on every face from where its outline comes
/// inside to where it leaves again, so that corners inside are cut off one by one.
std::array<int, 12> next_edges(std::uint8_t inside) {
  std::array<int, 12> next{};
  next.fill(kNoEdge);
  const auto is_inside = [inside](int corner) { return (inside >> corner & 1) != 0; };
  for (int face = 0; face < 6; ++face) {
    const std::array<int, 4> corner = face_corners(face);
    const auto at = [&corner](int i) { return corner[static_cast<std::size_t>(i % 4)]; };
    for (int i = 0; i < 4; ++i) {
      if (is_inside(at(i)) || !is_inside(at(i + 1))) continue;
      int last = i + 1;
      while (is_inside(at(last + 1))) ++last;
      next[static_cast<std::size_t>(edge_between(at(i), at(i + 1)))] =
          edge_between(at(last), at(last + 1));
    }
  }
  return next;
}

std::vector<Loop> loops_of(std::uint8_t inside) {
  std::array<int, 12> next = next_edges(inside);
  std::vector<Loop> loops;
  for (int start = 0; start < 12; ++start) {
    Loop loop;
    int e = start;
    while (next[static_cast<std::size_t>(e)] != kNoEdge) {
      loop.push_back(e);
      const int after = next[static_cast<std::size_t>(e)];
      next[static_cast<std::size_t>(e)] = kNoEdge;
      e = after;
    }
    if (!loop.empty()) loops.push_back(loop);
  }
  return loops;
}

/// Cuts the part of a loop from `first` to `last` into triangles with the fewest sides that run
/// across a face. Returns how many such sides there are.
int triangulate(const Loop& loop, std::size_t first, std::size_t last, CellTriangles& out) {
  if (last - first < 2) return 0;
  const auto side = [&](std::size_t a, std::size_t b) {
    const bool neighbours = b - a == 1 || b - a == loop.size() - 1;
    return !neighbours && share_face(loop[a], loop[b]) ? 1 : 0;
  };
  int best = 1000;
  CellTriangles best_triangles;
  for (std::size_t middle = first + 1; middle < last; ++middle) {
    CellTriangles part;
    int sides = side(first, middle) + side(middle, last);
    sides += triangulate(loop, first, middle, part);
    sides += triangulate(loop, middle, last, part);
    part.push_back({static_cast<std::uint8_t>(loop[first]),
                    static_cast<std::uint8_t>(loop[middle]),
                    static_cast<std::uint8_t>(loop[last])});
    if (sides < best) {
      best = sides;
      best_triangles = part;
    }
  }
  out.insert(out.end(), best_triangles.begin(), best_triangles.end());
  return best;
}

std::array<CellTriangles, 256> make_table() {
  std::array<CellTriangles, 256> table;
  for (std::size_t inside = 0; inside < table.size(); ++inside) {
    for (const Loop& loop : loops_of(static_cast<std::uint8_t>(inside))) {
      triangulate(loop, 0, loop.size() - 1, table[inside]);
    }
  }
  return table;
}

}  // namespace

const std::array<CellEdge, 12>& cell_edges() {
  return kCellEdges;
}

const std::vector<std::array<std::uint8_t, 3>>& cell_triangles(std::uint8_t inside) {
  static const std::array<CellTriangles, 256> table = make_table();
  return table[inside];
}

}  // namespace facula
