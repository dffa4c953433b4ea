// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/point_cloud.hpp>
#include <facula/acquire/core/rigid_transform.hpp>

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace facula {

/// Triangles over shared vertices, counter-clockwise seen from outside. Vertex attributes are
/// either empty or as long as `vertices`.
struct TriangleMesh {
  using Triangle = std::array<std::uint32_t, 3>;

  std::vector<Eigen::Vector3f> vertices;  ///< [m]
  std::vector<Triangle> triangles;        ///< indices of vertices [1]
  std::vector<Eigen::Vector3f> normals;   ///< unit length [1]
  std::vector<Color> colors;              ///< [0..255]

  bool empty() const { return triangles.empty(); }

  /// Throws Error when a triangle names a vertex that is not there or an attribute has the wrong
  /// length.
  void check() const;
};

/// The mesh in another frame.
TriangleMesh transformed(const TriangleMesh& mesh, const RigidTransform& target_from_source);

/// What a mesh is made of and whether it is closed.
struct MeshStatistics {
  std::size_t vertices = 0;            ///< [1]
  std::size_t triangles = 0;           ///< [1]
  std::size_t boundary_edges = 0;      ///< edges with one triangle [1]
  std::size_t non_manifold_edges = 0;  ///< edges with three triangles or more [1]
  std::size_t components = 0;          ///< pieces connected by edges [1]
  double area = 0;                     ///< [m^2]
  double volume = 0;                   ///< enclosed, meaningful when watertight [m^3]
  bool watertight = false;             ///< every edge has exactly two triangles
};

MeshStatistics mesh_statistics(const TriangleMesh& mesh);

}  // namespace facula
