// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/reconstruct/mesh/orient_mesh.hpp>

#include <algorithm>
#include <map>
#include <numeric>
#include <utility>

namespace facula {
namespace {

/// Pieces as a forest whose root stands for the piece (Tarjan's union-find).
class Pieces {
 public:
  explicit Pieces(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
  }
  std::size_t find(std::size_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::size_t a, std::size_t b) { parent_[find(b)] = find(a); }

 private:
  std::vector<std::size_t> parent_;
};

/// Joins triangles that share an edge.
Pieces pieces_of(const TriangleMesh& mesh) {
  Pieces pieces(mesh.triangles.size());
  std::vector<std::pair<std::pair<std::uint32_t, std::uint32_t>, std::size_t>> edges;
  edges.reserve(3 * mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::size_t i = 0; i < 3; ++i) {
      edges.push_back({std::minmax(mesh.triangles[t][i], mesh.triangles[t][(i + 1) % 3]), t});
    }
  }
  std::sort(edges.begin(), edges.end());
  for (std::size_t e = 1; e < edges.size(); ++e) {
    if (edges[e].first == edges[e - 1].first) pieces.join(edges[e - 1].second, edges[e].second);
  }
  return pieces;
}

/// How much the triangle speaks for its orientation: area times cosine, or volume.
double vote(const TriangleMesh& mesh,
            const TriangleMesh::Triangle& triangle,
            const std::vector<Eigen::Vector3f>& outward,
            const Eigen::Vector3d& centroid) {
  const Eigen::Vector3d a = mesh.vertices[triangle[0]].cast<double>();
  const Eigen::Vector3d b = mesh.vertices[triangle[1]].cast<double>();
  const Eigen::Vector3d c = mesh.vertices[triangle[2]].cast<double>();
  const Eigen::Vector3d area = (b - a).cross(c - a) / 2;
  if (outward.empty()) return area.dot((a + b + c) / 3 - centroid);
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();
  for (const std::uint32_t v : triangle) {
    direction += outward[v].cast<double>().stableNormalized();
  }
  return area.dot(direction);
}

}  // namespace

void orient_mesh(TriangleMesh& mesh, const std::vector<Eigen::Vector3f>& outward) {
  require(outward.empty() || outward.size() == mesh.vertices.size(),
          "orient_mesh got ",
          outward.size(),
          " directions for ",
          mesh.vertices.size(),
          " vertices");
  Eigen::Vector3d centroid = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3f& v : mesh.vertices) {
    centroid += v.cast<double>() / static_cast<double>(mesh.vertices.size());
  }
  Pieces pieces = pieces_of(mesh);
  std::vector<double> votes(mesh.triangles.size(), 0);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    votes[pieces.find(t)] += vote(mesh, mesh.triangles[t], outward, centroid);
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (votes[pieces.find(t)] < 0) std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
  }
}

}  // namespace facula
