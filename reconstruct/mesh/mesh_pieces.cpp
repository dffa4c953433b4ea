// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/disjoint_sets.hpp>
#include <facula/acquire/core/error.hpp>
#include <facula/reconstruct/mesh/mesh_cleaning.hpp>
#include <facula/reconstruct/mesh/mesh_pieces.hpp>
#include <facula/reconstruct/mesh/mesh_topology.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

namespace facula {

MeshPieces mesh_pieces(const TriangleMesh& mesh) {
  const MeshTopology topology = mesh_topology(mesh);
  DisjointSets sets(mesh.triangles.size());
  for (std::uint32_t half = 0; half < topology.opposite.size(); ++half) {
    const std::uint32_t other = topology.opposite[half];
    if (other < MeshTopology::kCrowded && half < other) sets.join(half / 3, other / 3);
  }
  for (const auto& [a, b] : topology.crowded) sets.join(a / 3, b / 3);
  MeshPieces pieces;
  pieces.of_triangle.resize(mesh.triangles.size());
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const std::uint32_t root = sets.find(t);  // the least triangle of its piece
    pieces.of_triangle[t] =
        root == t ? static_cast<std::uint32_t>(pieces.count++) : pieces.of_triangle[root];
  }
  return pieces;
}

void IslandOptions::check() const {
  require(min_diameter >= 0 && std::isfinite(min_diameter),
          "min_diameter is ",
          min_diameter,
          " m; give 0 or more");
  require(min_area >= 0 && min_area <= 1, "min_area is ", min_area, "; give a share of 0 to 1");
}

TriangleMesh without_islands(const TriangleMesh& mesh,
                             const IslandOptions& options,
                             std::size_t* removed) {
  options.check();
  const MeshPieces pieces = mesh_pieces(mesh);
  std::vector<double> area(pieces.count, 0);
  std::vector<Eigen::AlignedBox3f> box(pieces.count);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& [a, b, c] = mesh.triangles[t];
    const std::uint32_t piece = pieces.of_triangle[t];
    const Eigen::Vector3d corner = mesh.vertices[a].cast<double>();
    area[piece] += (mesh.vertices[b].cast<double>() - corner)
                       .cross(mesh.vertices[c].cast<double>() - corner)
                       .norm();
    for (const std::uint32_t v : {a, b, c}) box[piece].extend(mesh.vertices[v]);
  }
  const auto largest =
      static_cast<std::size_t>(std::max_element(area.begin(), area.end()) - area.begin());
  const auto stays = [&](std::size_t piece) {
    if (options.keep_largest && piece != largest) return false;
    return box[piece].diagonal().norm() >= options.min_diameter &&
           area[piece] >= options.min_area * area[largest];
  };
  std::vector<std::uint8_t> marked(mesh.triangles.size());
  for (std::size_t t = 0; t < marked.size(); ++t) marked[t] = stays(pieces.of_triangle[t]) ? 0 : 1;
  TriangleMesh rest = mesh;
  remove_triangles(rest, marked);
  if (removed != nullptr) {
    *removed = 0;
    for (std::size_t piece = 0; piece < pieces.count; ++piece) *removed += stays(piece) ? 0 : 1;
  }
  return compacted(rest);
}

std::size_t remove_triangles(TriangleMesh& mesh, const std::vector<std::uint8_t>& marked) {
  std::size_t kept = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (marked[t] == 0) mesh.triangles[kept++] = mesh.triangles[t];
  }
  const std::size_t removed = mesh.triangles.size() - kept;
  mesh.triangles.resize(kept);
  return removed;
}

TriangleMesh compacted(const TriangleMesh& mesh) {
  constexpr auto kUnused = std::numeric_limits<std::uint32_t>::max();
  mesh.check();
  std::vector<std::uint32_t> number(mesh.vertices.size(), kUnused);
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t v : triangle) number[v] = 0;
  }
  TriangleMesh result;
  for (std::size_t v = 0; v < number.size(); ++v) {
    if (number[v] == kUnused) continue;
    number[v] = static_cast<std::uint32_t>(result.vertices.size());
    result.vertices.push_back(mesh.vertices[v]);
    if (!mesh.normals.empty()) result.normals.push_back(mesh.normals[v]);
    if (!mesh.colors.empty()) result.colors.push_back(mesh.colors[v]);
  }
  result.triangles.reserve(mesh.triangles.size());
  for (const auto& [a, b, c] : mesh.triangles) {
    result.triangles.push_back({number[a], number[b], number[c]});
  }
  return result;
}

}  // namespace facula
