// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/parallel.hpp>
#include <facula/reconstruct/mesh/mesh_cleaning.hpp>
#include <facula/reconstruct/mesh/mesh_topology.hpp>

#include <algorithm>

namespace facula {
namespace {

constexpr double kInwards = 0.5;                              // lambda
constexpr double kPassBand = 0.1;                             // k_pb = 1 / lambda + 1 / mu
constexpr double kOutwards = 1 / (kPassBand - 1 / kInwards);  // mu

/// The neighbours of every vertex, those of vertex v from begin[v] to begin[v + 1].
struct Rings {
  std::vector<std::uint32_t> begin;
  std::vector<std::uint32_t> neighbour;
};

Rings rings_of(const TriangleMesh& mesh) {
  Rings rings;
  rings.begin.assign(mesh.vertices.size() + 1, 0);
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t v : triangle) ++rings.begin[v + 1];
  }
  for (std::size_t v = 1; v < rings.begin.size(); ++v) rings.begin[v] += rings.begin[v - 1];
  rings.neighbour.resize(3 * mesh.triangles.size());
  std::vector<std::uint32_t> place(rings.begin.begin(), rings.begin.end() - 1);
  // Inside a surface every neighbour follows the vertex in exactly one triangle.
  for (const auto& triangle : mesh.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      rings.neighbour[place[triangle[i]]++] = triangle[(i + 1) % 3];
    }
  }
  return rings;
}

std::vector<std::uint8_t> fixed_vertices(const TriangleMesh& mesh) {
  const MeshTopology topology = mesh_topology(mesh);
  std::vector<std::uint8_t> fixed(mesh.vertices.size(), 0);
  for (std::uint32_t half = 0; half < topology.opposite.size(); ++half) {
    if (topology.opposite[half] < MeshTopology::kCrowded) continue;
    fixed[MeshTopology::origin(mesh, half)] = 1;
    fixed[MeshTopology::origin(mesh, MeshTopology::next(half))] = 1;
  }
  return fixed;
}

}  // namespace

TriangleMesh smoothed(const TriangleMesh& mesh, int steps, int num_threads) {
  require(steps >= 0, "steps is ", steps, "; give 0 or more");
  TriangleMesh result = mesh;
  if (steps == 0) return result;
  result.normals.clear();
  const Rings rings = rings_of(mesh);
  const std::vector<std::uint8_t> fixed = fixed_vertices(mesh);
  std::vector<Eigen::Vector3f> before;
  for (int step = 0; step < 2 * steps; ++step) {
    before = result.vertices;
    const double share = step % 2 == 0 ? kInwards : kOutwards;
    const auto move = [&](std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v < end; ++v) {
        const std::uint32_t count = rings.begin[v + 1] - rings.begin[v];
        if (fixed[v] != 0 || count == 0) continue;
        Eigen::Vector3d mean = Eigen::Vector3d::Zero();
        for (std::uint32_t i = rings.begin[v]; i < rings.begin[v + 1]; ++i) {
          mean += before[rings.neighbour[i]].cast<double>();
        }
        const Eigen::Vector3d here = before[v].cast<double>();
        result.vertices[v] = (here + share * (mean / count - here)).cast<float>();
      }
    };
    parallel_for(mesh.vertices.size(), move, {num_threads, 4096});
  }
  return result;
}

}  // namespace facula
