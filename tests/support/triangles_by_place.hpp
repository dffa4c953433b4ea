// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/triangle_mesh.hpp>

#include <algorithm>
#include <array>
#include <vector>

namespace facula {

/// The corners of a triangle, each x, y, z.
using PlacedTriangle = std::array<std::array<float, 3>, 3>;

/// The triangles by their corners' coordinates, the least corner first, in ascending order: equal
/// for meshes that differ in the order of vertices and triangles alone.
inline std::vector<PlacedTriangle> triangles_by_place(const TriangleMesh& mesh) {
  std::vector<PlacedTriangle> result;
  result.reserve(mesh.triangles.size());
  for (const TriangleMesh::Triangle& triangle : mesh.triangles) {
    PlacedTriangle corners;
    for (std::size_t i = 0; i < 3; ++i) {
      const Eigen::Vector3f& p = mesh.vertices[triangle[i]];
      corners[i] = {p.x(), p.y(), p.z()};
    }
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    result.push_back(corners);
  }
  std::sort(result.begin(), result.end());
  return result;
}

}  // namespace facula
