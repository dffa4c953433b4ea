// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/reconstruct/mesh/mesh_topology.hpp>
#include <facula/reconstruct/mesh/mesh_verdict.hpp>
#include <facula/reconstruct/mesh/meshing.hpp>

#include <algorithm>
#include <cmath>
#include <sstream>

#include <Eigen/Geometry>

namespace facula {
namespace {

std::vector<BoundaryLoop> measured_loops(const TriangleMesh& mesh, const MeshTopology& topology) {
  std::vector<BoundaryLoop> loops;
  for (const auto& halves : boundary_loops(mesh, topology)) {
    BoundaryLoop loop{halves.size(), 0, 0};
    Eigen::AlignedBox3d box;
    for (const std::uint32_t half : halves) {
      const Eigen::Vector3d from = mesh.vertices[MeshTopology::origin(mesh, half)].cast<double>();
      const Eigen::Vector3d to =
          mesh.vertices[MeshTopology::origin(mesh, MeshTopology::next(half))].cast<double>();
      loop.length += (to - from).norm();
      box.extend(from).extend(to);
    }
    loop.diameter = box.diagonal().norm();
    loops.push_back(loop);
  }
  std::stable_sort(loops.begin(), loops.end(), [](const BoundaryLoop& a, const BoundaryLoop& b) {
    return a.length > b.length;
  });
  return loops;
}

/// Handles over all pieces: Euler's V - E + F = 2 (pieces - genus) on closed manifolds.
long genus_of(const MeshTopology& topology, std::size_t fans, const MeshStatistics& statistics) {
  const long euler = static_cast<long>(fans) - static_cast<long>(topology.edges) +
                     static_cast<long>(statistics.triangles);
  return static_cast<long>(statistics.components) - euler / 2;
}

void add_part(std::ostringstream& sentence,
              std::size_t count,
              const char* one,
              const char* several) {
  if (count == 0) return;
  if (!sentence.str().empty()) sentence << ", ";
  sentence << count << ' ' << (count == 1 ? one : several);
}

}  // namespace

bool MeshVerdict::watertight() const {
  return closed && manifold && self_intersections == 0 && triangles_without_area == 0 &&
         volume.value_or(0) > 0;
}

std::string MeshVerdict::sentence() const {
  if (watertight()) return "closed, manifold, without self-intersections";
  if (statistics.triangles == 0) return "no triangles";
  std::ostringstream what;
  add_part(what, loops.size(), "boundary loop", "boundary loops");
  add_part(what,
           statistics.non_manifold_edges,
           "edge of three triangles or more",
           "edges of three triangles or more");
  add_part(what,
           non_manifold_vertices,
           "vertex where pieces only touch",
           "vertices where pieces only touch");
  add_part(what,
           turned_edges,
           "edge between triangles turned against each other",
           "edges between triangles turned against each other");
  add_part(what,
           self_intersections,
           "pair of triangles that cut each other",
           "pairs of triangles that cut each other");
  add_part(what, triangles_without_area, "triangle without area", "triangles without area");
  if (what.str().empty()) what << "turned inside out";
  return what.str();
}

MeshDeviation deviation_from_mesh(const std::vector<Eigen::Vector3f>& points,
                                  const TriangleMesh& mesh,
                                  int num_threads) {
  std::vector<double> distances = distances_to_mesh(points, mesh, num_threads);
  std::erase_if(distances, [](double d) { return !std::isfinite(d); });
  MeshDeviation deviation{distances.size(), 0, 0, 0};
  if (distances.empty()) return deviation;
  const auto at = [&](double share) {
    const auto rank = static_cast<std::ptrdiff_t>(
        std::llround(share * static_cast<double>(distances.size() - 1)));
    std::nth_element(distances.begin(), distances.begin() + rank, distances.end());
    return distances[static_cast<std::size_t>(rank)];
  };
  deviation.median = at(0.5);
  deviation.p95 = at(0.95);
  deviation.max = at(1.0);
  return deviation;
}

MeshVerdict judge_mesh(const TriangleMesh& mesh,
                       const std::vector<Eigen::Vector3f>& points,
                       int num_threads) {
  MeshVerdict verdict;
  verdict.statistics = mesh_statistics(mesh);
  const MeshTopology topology = mesh_topology(mesh);
  const VertexFans fans = vertex_fans(mesh, topology);
  verdict.loops = measured_loops(mesh, topology);
  verdict.non_manifold_vertices = fans.crowded_vertices;
  verdict.turned_edges = topology.turned_edges;
  const auto flat = triangles_without_area(mesh);
  verdict.triangles_without_area =
      static_cast<std::size_t>(std::count(flat.begin(), flat.end(), std::uint8_t{1}));
  verdict.self_intersections = self_intersections(mesh, num_threads).size();
  verdict.closed = !mesh.empty() && topology.border_edges == 0;
  verdict.manifold = !mesh.empty() && topology.crowded_edges == 0 && topology.turned_edges == 0 &&
                     fans.crowded_vertices == 0;
  if (verdict.closed && verdict.manifold) {
    verdict.genus = genus_of(topology, fans.vertex_of_fan.size(), verdict.statistics);
    verdict.volume = verdict.statistics.volume;
  }
  const bool has_surface = verdict.triangles_without_area < mesh.triangles.size();
  if (!points.empty() && has_surface) {
    verdict.deviation = deviation_from_mesh(points, mesh, num_threads);
  }
  return verdict;
}

}  // namespace facula
