// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/disjoint_sets.hpp>
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/triangle_mesh.hpp>

#include <algorithm>
#include <tuple>

#include <Eigen/Geometry>

namespace facula {
namespace {

struct Edge {
  std::uint32_t low;
  std::uint32_t high;
  std::uint32_t triangle;
};

std::vector<Edge> sorted_edges(const TriangleMesh& mesh) {
  std::vector<Edge> edges;
  edges.reserve(mesh.triangles.size() * 3);
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax(mesh.triangles[t][k], mesh.triangles[t][(k + 1) % 3]);
      edges.push_back({low, high, t});
    }
  }
  std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
    return std::tie(a.low, a.high, a.triangle) < std::tie(b.low, b.high, b.triangle);
  });
  return edges;
}

void count_edges(const TriangleMesh& mesh, MeshStatistics& result) {
  const std::vector<Edge> edges = sorted_edges(mesh);
  DisjointSets sets(mesh.triangles.size());  // of triangles, joined across shared edges
  for (std::size_t i = 0; i < edges.size();) {
    std::size_t j = i + 1;
    while (j < edges.size() && edges[j].low == edges[i].low && edges[j].high == edges[i].high) {
      sets.join(edges[i].triangle, edges[j].triangle);
      ++j;
    }
    if (j - i == 1) ++result.boundary_edges;
    if (j - i > 2) ++result.non_manifold_edges;
    i = j;
  }
  result.components = sets.count();
  result.watertight = !mesh.empty() && result.boundary_edges == 0 && result.non_manifold_edges == 0;
}

}  // namespace

void TriangleMesh::check() const {
  for (const Triangle& t : triangles) {
    for (const std::uint32_t v : t) {
      require(v < vertices.size(),
              "a triangle names vertex ",
              v,
              " where the mesh has ",
              vertices.size(),
              " vertices");
    }
  }
  require(normals.empty() || normals.size() == vertices.size(),
          "the mesh has ",
          normals.size(),
          " normals for ",
          vertices.size(),
          " vertices");
  require(colors.empty() || colors.size() == vertices.size(),
          "the mesh has ",
          colors.size(),
          " colours for ",
          vertices.size(),
          " vertices");
}

TriangleMesh transformed(const TriangleMesh& mesh, const RigidTransform& target_from_source) {
  TriangleMesh result = mesh;
  for (auto& v : result.vertices) v = (target_from_source * v.cast<double>()).cast<float>();
  for (auto& n : result.normals) n = target_from_source.rotation.cast<float>() * n;
  return result;
}

MeshStatistics mesh_statistics(const TriangleMesh& mesh) {
  mesh.check();
  MeshStatistics result;
  result.vertices = mesh.vertices.size();
  result.triangles = mesh.triangles.size();
  for (const auto& t : mesh.triangles) {
    const Eigen::Vector3d a = mesh.vertices[t[0]].cast<double>();
    const Eigen::Vector3d b = mesh.vertices[t[1]].cast<double>();
    const Eigen::Vector3d c = mesh.vertices[t[2]].cast<double>();
    result.area += 0.5 * (b - a).cross(c - a).norm();
    result.volume += a.dot(b.cross(c)) / 6.0;
  }
  count_edges(mesh, result);
  return result;
}

}  // namespace facula
