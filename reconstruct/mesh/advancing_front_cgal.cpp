// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/reconstruct/mesh/mesh_engines.hpp>
#include <facula/reconstruct/mesh/meshing.hpp>
#include <facula/reconstruct/mesh/orient_mesh.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <CGAL/Advancing_front_surface_reconstruction.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

namespace facula {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Facet = std::array<std::size_t, 3>;

/// Forbids triangles with an edge longer than the bound; ranks the others as CGAL does by default.
class EdgeBound {
 public:
  explicit EdgeBound(double longest) : squared_(longest * longest) {}

  template <typename AdvancingFront, typename CellHandle>
  double operator()(const AdvancingFront& front, CellHandle& cell, const int& index) const {
    double longest = 0;
    for (int i = 1; i <= 3; ++i) {
      const auto& a = cell->vertex((index + i) & 3)->point();
      const auto& b = cell->vertex((index + i % 3 + 1) & 3)->point();
      longest = std::max(longest, CGAL::to_double(CGAL::squared_distance(a, b)));
    }
    if (longest > squared_) return front.infinity();
    return front.smallest_radius_delaunay_sphere(cell, index);
  }

 private:
  double squared_;
};

/// The mesh of the facets, with only those points that a facet uses.
TriangleMesh mesh_of(const PointCloud& cloud,
                     const std::vector<Facet>& facets,
                     std::vector<std::size_t>& point_of_vertex) {
  constexpr auto kUnused = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> vertex_of(cloud.size(), kUnused);
  TriangleMesh mesh;
  for (const Facet& facet : facets) {
    TriangleMesh::Triangle triangle{};
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const std::size_t point = facet[corner];
      if (vertex_of[point] == kUnused) {
        vertex_of[point] = static_cast<std::uint32_t>(mesh.vertices.size());
        mesh.vertices.push_back(cloud.points[point]);
        if (!cloud.normals.empty()) mesh.normals.push_back(cloud.normals[point]);
        if (!cloud.colors.empty()) mesh.colors.push_back(cloud.colors[point]);
        point_of_vertex.push_back(point);
      }
      triangle[corner] = vertex_of[point];
    }
    mesh.triangles.push_back(triangle);
  }
  return mesh;
}

/// Where the outside lies at every vertex, as far as the cloud tells.
std::vector<Eigen::Vector3f> outward_directions(const PointCloud& cloud,
                                                const std::vector<std::size_t>& point_of_vertex) {
  std::vector<Eigen::Vector3f> outward;
  if (cloud.sensor_origin.empty() && cloud.normals.empty()) return outward;
  for (const std::size_t point : point_of_vertex) {
    outward.push_back(cloud.sensor_origin.empty()
                          ? cloud.normals[point]
                          : Eigen::Vector3f(cloud.sensor_origin[point] - cloud.points[point]));
  }
  return outward;
}

}  // namespace

void AdvancingFrontOptions::check() const {
  require(max_edge >= 0 && std::isfinite(max_edge),
          "max_edge is ",
          max_edge,
          " m; give a length, or 0 for 6 times the point spacing");
  require(radius_ratio_bound > 0, "radius_ratio_bound is ", radius_ratio_bound, "; give above 0");
  require(beta > 0 && beta < 3.2, "beta is ", beta, " rad; give an angle above 0, below pi");
}

TriangleMesh mesh_advancing_front(const PointCloud& cloud, const AdvancingFrontOptions& options) {
  options.check();
  const PointCloud input = surface_points(cloud);
  std::vector<Kernel::Point_3> points;
  points.reserve(input.size());
  for (const Eigen::Vector3f& p : input.points) points.emplace_back(p.x(), p.y(), p.z());
  const double longest = options.max_edge > 0 ? options.max_edge : reaching_edge(input);
  std::vector<Facet> facets;
  CGAL::advancing_front_surface_reconstruction(points.begin(),
                                               points.end(),
                                               std::back_inserter(facets),
                                               EdgeBound(longest),
                                               options.radius_ratio_bound,
                                               options.beta);
  std::vector<std::size_t> point_of_vertex;
  TriangleMesh mesh = mesh_of(input, facets, point_of_vertex);
  orient_mesh(mesh, outward_directions(input, point_of_vertex));
  return mesh;
}

}  // namespace facula
