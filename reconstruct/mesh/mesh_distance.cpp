// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/parallel.hpp>
#include <facula/reconstruct/mesh/meshing.hpp>
#include <facula/reconstruct/mesh/triangle_tree.hpp>

#include <cmath>
#include <limits>

namespace facula {
namespace {

bool has_surface(const TriangleMesh& mesh) {
  for (const auto& [a, b, c] : mesh.triangles) {
    const Eigen::Vector3d corner = mesh.vertices[a].cast<double>();
    const Eigen::Vector3d area =
        (mesh.vertices[b].cast<double>() - corner).cross(mesh.vertices[c].cast<double>() - corner);
    if (area.squaredNorm() > 0) return true;  // false for NaN as well
  }
  return false;
}

}  // namespace

std::vector<double> distances_to_mesh(const std::vector<Eigen::Vector3f>& points,
                                      const TriangleMesh& mesh,
                                      int num_threads) {
  mesh.check();
  require(has_surface(mesh), "the mesh has no triangle with an area; distances need a surface");
  const TriangleTree tree(mesh);
  std::vector<double> distances(points.size(), std::numeric_limits<double>::quiet_NaN());
  const auto measure = [&](std::size_t begin, std::size_t end) {
    std::uint32_t near = 0;  // points often follow each other
    for (std::size_t i = begin; i < end; ++i) {
      if (!points[i].allFinite()) continue;
      const auto [squared, triangle] = tree.nearest_from(points[i].cast<double>(), near);
      distances[i] = std::sqrt(squared);
      near = triangle;
    }
  };
  parallel_for(points.size(), measure, {num_threads, 512});
  return distances;
}

}  // namespace facula
