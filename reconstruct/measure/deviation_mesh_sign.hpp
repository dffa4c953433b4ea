// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/triangle_mesh.hpp>

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace facula {

/// Normals of the faces, edges and corners of a mesh that tell on which side of it a point lies
/// (Baerentzen and Aanaes, Signed distance computation using the angle weighted pseudonormal,
/// 2005).
class MeshSides {
 public:
  explicit MeshSides(const TriangleMesh& mesh);

  struct Place {
    Eigen::Vector3d nearest;  ///< on the triangle [m]
    bool in_front = true;     ///< the point lies on the side of the normal
    bool on_rim = false;      ///< the nearest place lies on an edge with one triangle
  };

  /// Where `point` lies, given the triangle that is nearest to it.
  Place place(const Eigen::Vector3d& point, std::uint32_t triangle) const;

 private:
  void collect_edges();

  const TriangleMesh& mesh_;
  std::vector<Eigen::Vector3d> faces_;                 // unit length, 0 for needles
  std::vector<Eigen::Vector3d> corners_;               // per vertex, weighted by angle
  std::vector<bool> rim_corner_;                       // per vertex
  std::vector<std::array<Eigen::Vector3d, 3>> edges_;  // per triangle, edge i to i + 1
  std::vector<std::array<bool, 3>> rim_edge_;          // per triangle
};

}  // namespace facula
