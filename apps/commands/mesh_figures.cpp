// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/apps/commands/mesh_figures.hpp>

namespace facula {

void report_mesh(const TriangleMesh& mesh, Figures& figures) {
  const MeshStatistics statistics = mesh_statistics(mesh);
  figures.count("vertices", "vertices", statistics.vertices);
  figures.count("triangles", "triangles", statistics.triangles);
  figures.number("area_m2", "area", statistics.area, 6);
  figures.count("boundary_edges", "boundary edges", statistics.boundary_edges);
  figures.count("non_manifold_edges", "non-manifold edges", statistics.non_manifold_edges);
  figures.count("components", "pieces", statistics.components);
  figures.flag("watertight", "watertight", statistics.watertight);
  if (statistics.watertight) figures.number("volume_m3", "volume", statistics.volume, 6);
}

}  // namespace facula
