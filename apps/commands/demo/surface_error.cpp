// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/parallel.hpp>
#include <facula/apps/commands/demo/surface_error.hpp>
#include <facula/apps/commands/distance_figures.hpp>

#include <vector>

namespace facula {

void report_mesh_error(const TriangleMesh& mesh,
                       const Scene& scene,
                       int num_threads,
                       Figures& figures) {
  std::vector<double> distances(mesh.vertices.size());
  parallel_for(mesh.vertices.size(),
               [&](std::size_t begin, std::size_t end) {
                 for (std::size_t i = begin; i < end; ++i) {
                   distances[i] = scene.distance(mesh.vertices[i].cast<double>());
                 }
               },
               {num_threads, 1024});
  const MeshStatistics statistics = mesh_statistics(mesh);
  const Spread spread = spread_of(distances);
  figures.count("vertices", "vertices", statistics.vertices);
  figures.count("triangles", "triangles", statistics.triangles);
  figures.number("area_m2", "area", statistics.area, 4);
  figures.count("boundary_edges", "boundary edges", statistics.boundary_edges);
  figures.number(
      "surface_error_median_mm", "distance to the scene, median", 1000 * spread.median, 3);
  figures.number("surface_error_rms_mm", "distance to the scene, rms", 1000 * spread.rms, 3);
  figures.number(
      "surface_error_p95_mm", "distance to the scene, 95 of 100 below", 1000 * spread.p95, 3);
}

}  // namespace facula
