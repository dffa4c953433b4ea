// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/reconstruct/mesh/mesh_engines.hpp>

#include <cmath>
#include <limits>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Scale_space_reconstruction_3/Advancing_front_mesher.h>
#include <CGAL/Scale_space_reconstruction_3/Weighted_PCA_smoother.h>
#include <CGAL/Scale_space_surface_reconstruction_3.h>

namespace facula {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Reconstruction = CGAL::Scale_space_surface_reconstruction_3<Kernel>;
using Smoother = CGAL::Scale_space_reconstruction_3::Weighted_PCA_smoother<Kernel>;
using Mesher = CGAL::Scale_space_reconstruction_3::Advancing_front_mesher<Kernel>;

/// The facets' triangles over those points that a facet uses.
TriangleMesh mesh_of(const Reconstruction& reconstruction, const PointCloud& cloud) {
  constexpr auto kUnused = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> vertex_of(cloud.size(), kUnused);
  TriangleMesh mesh;
  for (auto facet = reconstruction.facets_begin(); facet != reconstruction.facets_end(); ++facet) {
    TriangleMesh::Triangle triangle{};
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const std::size_t point = (*facet)[corner];
      if (vertex_of[point] == kUnused) {
        vertex_of[point] = static_cast<std::uint32_t>(mesh.vertices.size());
        mesh.vertices.push_back(cloud.points[point]);
        if (!cloud.colors.empty()) mesh.colors.push_back(cloud.colors[point]);
      }
      triangle[corner] = vertex_of[point];
    }
    mesh.triangles.push_back(triangle);
  }
  return mesh;
}

}  // namespace

void ScaleSpaceOptions::check() const {
  require(iterations >= 1, "iterations is ", iterations, "; give 1 or more");
  require(neighbours >= 3, "neighbours is ", neighbours, "; give 3 or more");
  require(max_edge >= 0 && std::isfinite(max_edge), "max_edge is ", max_edge, " m; give 0 or more");
}

TriangleMesh mesh_scale_space(const PointCloud& cloud, const ScaleSpaceOptions& options) {
  options.check();
  const PointCloud input = surface_points(cloud);
  const Eigen::Vector3f centre = input.points.front();
  Reconstruction reconstruction;
  for (const Eigen::Vector3f& point : input.points) {
    const Eigen::Vector3f p = point - centre;
    reconstruction.insert(Kernel::Point_3(p.x(), p.y(), p.z()));
  }
  reconstruction.increase_scale(static_cast<std::size_t>(options.iterations),
                                Smoother(static_cast<unsigned>(options.neighbours)));
  const double longest = options.max_edge > 0 ? options.max_edge : reaching_edge(input);
  reconstruction.reconstruct_surface(Mesher(longest));
  TriangleMesh mesh = mesh_of(reconstruction, input);
  orient_by_points(mesh, input);
  return mesh;
}

}  // namespace facula
