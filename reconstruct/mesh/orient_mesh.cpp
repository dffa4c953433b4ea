// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/reconstruct/mesh/mesh_pieces.hpp>
#include <facula/reconstruct/mesh/orient_mesh.hpp>

#include <algorithm>

#include <Eigen/Geometry>

namespace facula {
namespace {

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
  const MeshPieces pieces = mesh_pieces(mesh);
  std::vector<double> votes(pieces.count, 0);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    votes[pieces.of_triangle[t]] += vote(mesh, mesh.triangles[t], outward, centroid);
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (votes[pieces.of_triangle[t]] < 0) std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
  }
}

}  // namespace facula
