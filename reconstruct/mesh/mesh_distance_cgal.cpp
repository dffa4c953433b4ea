// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/parallel.hpp>
#include <facula/reconstruct/mesh/meshing.hpp>

#include <cmath>
#include <limits>

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>

namespace facula {
namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using Triangles = std::vector<Kernel::Triangle_3>;
using Primitive = CGAL::AABB_triangle_primitive<Kernel, Triangles::const_iterator>;
using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;

Kernel::Point_3 to_cgal(const Eigen::Vector3f& p) {
  return {p.x(), p.y(), p.z()};
}

/// The mesh's triangles without those that have no area: they add nothing to the surface.
Triangles triangles_of(const TriangleMesh& mesh) {
  Triangles triangles;
  triangles.reserve(mesh.triangles.size());
  for (const auto& [a, b, c] : mesh.triangles) {
    const Kernel::Triangle_3 triangle(
        to_cgal(mesh.vertices[a]), to_cgal(mesh.vertices[b]), to_cgal(mesh.vertices[c]));
    if (triangle.squared_area() > 0) triangles.push_back(triangle);
  }
  return triangles;
}

}  // namespace

std::vector<double> distances_to_mesh(const std::vector<Eigen::Vector3f>& points,
                                      const TriangleMesh& mesh) {
  mesh.check();
  const Triangles triangles = triangles_of(mesh);
  require(!triangles.empty(), "the mesh has no triangle with an area; distances need a surface");
  Tree tree(triangles.begin(), triangles.end());
  tree.build();
  tree.accelerate_distance_queries();
  std::vector<double> distances(points.size(), std::numeric_limits<double>::quiet_NaN());
  const auto measure = [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (!points[i].allFinite()) continue;
      distances[i] = std::sqrt(tree.squared_distance(to_cgal(points[i])));
    }
  };
  parallel_for(points.size(), measure, {.num_threads = 0, .chunk = 512});
  return distances;
}

}  // namespace facula
