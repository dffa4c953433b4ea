// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/tests/support/meshes.hpp>

#include <Eigen/Geometry>

namespace facula {

TriangleMesh box_mesh(float a, float b, float c) {
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i) {
    mesh.vertices.emplace_back((i & 1) != 0 ? a : 0, (i & 2) != 0 ? b : 0, (i & 4) != 0 ? c : 0);
  }
  mesh.triangles = {{0, 2, 1},
                    {1, 2, 3},
                    {4, 5, 6},
                    {5, 7, 6},
                    {0, 1, 4},
                    {1, 5, 4},
                    {2, 6, 3},
                    {3, 6, 7},
                    {0, 4, 2},
                    {2, 4, 6},
                    {1, 3, 5},
                    {3, 7, 5}};
  return mesh;
}

std::vector<Eigen::Vector3f> vertex_normals(const TriangleMesh& mesh) {
  std::vector<Eigen::Vector3f> normals(mesh.vertices.size(), Eigen::Vector3f::Zero());
  for (const auto& [a, b, c] : mesh.triangles) {
    const Eigen::Vector3f area =
        (mesh.vertices[b] - mesh.vertices[a]).cross(mesh.vertices[c] - mesh.vertices[a]);
    for (const auto v : {a, b, c}) normals[v] += area;
  }
  for (Eigen::Vector3f& n : normals) n.stableNormalize();
  return normals;
}

}  // namespace facula
