// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/triangle_mesh.hpp>

#include <vector>

#include <CGAL/Surface_mesh.h>
#include <CGAL/number_utils.h>

// Converters for those who use CGAL beside Facula. Only this header and *_cgal.cpp name CGAL.

namespace facula {

/// The mesh as a CGAL surface mesh, vertices in the same order. Throws Error where the triangles
/// are no manifold of one orientation, which a Surface_mesh cannot hold.
template <typename Point>
CGAL::Surface_mesh<Point> to_cgal(const TriangleMesh& mesh) {
  mesh.check();
  CGAL::Surface_mesh<Point> result;
  std::vector<typename CGAL::Surface_mesh<Point>::Vertex_index> vertices;
  vertices.reserve(mesh.vertices.size());
  for (const Eigen::Vector3f& v : mesh.vertices) {
    vertices.push_back(result.add_vertex(Point(v.x(), v.y(), v.z())));
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& [a, b, c] = mesh.triangles[t];
    const auto face = result.add_face(vertices[a], vertices[b], vertices[c]);
    require(face != CGAL::Surface_mesh<Point>::null_face(),
            "triangle ",
            t,
            " shares an edge with two others or is turned against its neighbour, which a CGAL "
            "surface mesh cannot hold");
  }
  return result;
}

/// A CGAL surface mesh as triangles; faces with more corners are split into fans. Removed vertices
/// and faces are left out.
template <typename Point>
TriangleMesh from_cgal(const CGAL::Surface_mesh<Point>& mesh) {
  TriangleMesh result;
  std::vector<std::uint32_t> number(mesh.num_vertices() + mesh.number_of_removed_vertices());
  for (const auto v : mesh.vertices()) {
    number[static_cast<std::size_t>(v)] = static_cast<std::uint32_t>(result.vertices.size());
    const Point& p = mesh.point(v);
    result.vertices.emplace_back(static_cast<float>(CGAL::to_double(p.x())),
                                 static_cast<float>(CGAL::to_double(p.y())),
                                 static_cast<float>(CGAL::to_double(p.z())));
  }
  for (const auto face : mesh.faces()) {
    std::vector<std::uint32_t> corners;
    for (const auto v : mesh.vertices_around_face(mesh.halfedge(face))) {
      corners.push_back(number[static_cast<std::size_t>(v)]);
    }
    for (std::size_t i = 2; i < corners.size(); ++i) {
      result.triangles.push_back({corners[0], corners[i - 1], corners[i]});
    }
  }
  return result;
}

}  // namespace facula
