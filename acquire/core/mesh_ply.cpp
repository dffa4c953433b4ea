// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/cloud_columns.hpp>
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/mesh_formats.hpp>
#include <facula/acquire/core/ply_table.hpp>

#include <cmath>

namespace facula {
namespace {

std::uint32_t index_of(double value, const std::filesystem::path& path) {
  require(value >= 0 && value < 0xFFFFFFFFp0 && value == std::floor(value),
          "a face of '",
          path.string(),
          "' names vertex ",
          value,
          "; expected a whole number of 0 or more");
  return static_cast<std::uint32_t>(value);
}

void read_faces(const PlyElement& faces, TriangleMesh& mesh, const std::filesystem::path& path) {
  const PlyProperty* lists = faces.find("vertex_indices");
  if (lists == nullptr) lists = faces.find("vertex_index");
  require(lists != nullptr && lists->count_type,
          "the faces of '",
          path.string(),
          "' have no list vertex_indices; choose a file with a mesh");
  std::vector<std::uint32_t> corners;
  std::size_t begin = 0;
  for (const std::size_t end : lists->ends) {
    corners.clear();
    for (; begin < end; ++begin) corners.push_back(index_of(lists->values[begin], path));
    add_fan(mesh, corners, path);
  }
}

/// A mesh needs every vertex, so a vertex without a position must not be dropped as in a cloud.
void read_vertices(const PlyElement& vertices,
                   TriangleMesh& mesh,
                   const std::filesystem::path& path) {
  const auto find = [&](const std::string& name) -> const NumberColumn* {
    const PlyProperty* property = vertices.find(name);
    return property == nullptr || property->count_type ? nullptr : property;
  };
  PointCloud cloud = cloud_from_columns(find, path);
  require(cloud.size() == vertices.rows,
          "the mesh of '",
          path.string(),
          "' has a vertex that is not a finite point; repair the mesh");
  mesh.vertices = std::move(cloud.points);
  mesh.normals = std::move(cloud.normals);
  mesh.colors = std::move(cloud.colors);
}

}  // namespace

TriangleMesh read_ply_mesh(const std::filesystem::path& path) {
  const std::vector<PlyElement> elements = read_ply(path);
  TriangleMesh mesh;
  read_vertices(ply_element(elements, "vertex", path), mesh, path);
  read_faces(ply_element(elements, "face", path), mesh, path);
  return mesh;
}

void write_ply_mesh(const std::filesystem::path& path, const TriangleMesh& mesh) {
  PointCloud cloud;
  cloud.points = mesh.vertices;
  cloud.normals = mesh.normals;
  cloud.colors = mesh.colors;
  PlyElement vertices{"vertex", mesh.vertices.size(), {}};
  for (NumberColumn& column : ply_columns(cloud)) {
    vertices.properties.push_back({std::move(column), std::nullopt, {}});
  }
  PlyProperty corners{{"vertex_indices", NumberType::kInt32, {}}, NumberType::kUint8, {}};
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t v : triangle) corners.values.push_back(v);
    corners.ends.push_back(corners.values.size());
  }
  write_ply(path, {vertices, {"face", mesh.triangles.size(), {corners}}});
}

}  // namespace facula
