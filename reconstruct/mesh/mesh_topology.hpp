// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/triangle_mesh.hpp>

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

namespace facula {

/// How the triangles of a mesh meet. Half-edge 3 t + i runs along triangle t from its corner i to
/// the next one; corner 3 t + i is where it starts.
struct MeshTopology {
  static constexpr std::uint32_t kBorder = std::numeric_limits<std::uint32_t>::max();
  static constexpr std::uint32_t kCrowded = kBorder - 1;

  /// The half-edge of the only other triangle at this edge; kBorder where there is none, kCrowded
  /// where there are several.
  std::vector<std::uint32_t> opposite;
  /// Half-edges that share an edge of three triangles or more, one link less than triangles.
  std::vector<std::array<std::uint32_t, 2>> crowded;
  std::size_t crowded_edges = 0;  ///< edges of three triangles or more [1]
  std::size_t border_edges = 0;   ///< edges of one triangle [1]
  std::size_t edges = 0;          ///< all edges [1]
  /// Edges that both their triangles run along the same way: one is turned against the other [1].
  std::size_t turned_edges = 0;

  static std::uint32_t next(std::uint32_t half) { return half % 3 == 2 ? half - 2 : half + 1; }
  static std::uint32_t origin(const TriangleMesh& mesh, std::uint32_t half) {
    return mesh.triangles[half / 3][half % 3];
  }
};

/// Throws Error when a triangle names a vertex that is not there.
MeshTopology mesh_topology(const TriangleMesh& mesh);

/// The corners at a vertex that hang together through edges of two triangles form a fan. Where the
/// mesh is a manifold there is one fan at every vertex.
struct VertexFans {
  std::vector<std::uint32_t> fan_of_corner;  ///< numbered in the order of their first corner [1]
  std::vector<std::uint32_t> vertex_of_fan;  ///< [1]
  std::size_t crowded_vertices = 0;          ///< vertices with several fans [1]
};

VertexFans vertex_fans(const TriangleMesh& mesh, const MeshTopology& topology);

/// Half-edges of every boundary loop in order along the boundary; loops in the order of their first
/// triangle. At edges of three triangles or more a loop may end without closing.
std::vector<std::vector<std::uint32_t>> boundary_loops(const TriangleMesh& mesh,
                                                       const MeshTopology& topology);

}  // namespace facula
