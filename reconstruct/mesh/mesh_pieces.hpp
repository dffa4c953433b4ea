// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/triangle_mesh.hpp>

#include <cstdint>
#include <vector>

namespace facula {

/// The pieces of a mesh: triangles that hang together through edges.
struct MeshPieces {
  std::vector<std::uint32_t> of_triangle;  ///< numbered in the order of their first triangle [1]
  std::size_t count = 0;                   ///< [1]
};

/// Throws Error when a triangle names a vertex that is not there.
MeshPieces mesh_pieces(const TriangleMesh& mesh);

}  // namespace facula
