// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/mesh_file.hpp>
#include <facula/acquire/core/mesh_formats.hpp>
#include <facula/acquire/core/whole_file.hpp>

#include <cmath>

namespace facula {
namespace {

TriangleMesh read_by_extension(const std::filesystem::path& path) {
  const std::string extension = lower_extension(path);
  if (extension == ".ply") return read_ply_mesh(path);
  if (extension == ".obj") return read_obj_mesh(path);
  if (extension == ".stl") return read_stl_mesh(path);
  if (extension == ".off") return read_off_mesh(path);
  fail("cannot read a mesh from '",
       path.string(),
       "': expected a name that ends in .ply, .obj, .stl or .off");
}

void check_unit(double unit) {
  require(std::isfinite(unit) && unit > 0,
          "a mesh's unit must be a length above 0 m, got ",
          unit,
          "; give 0.001 for millimetres");
}

TriangleMesh scaled(TriangleMesh mesh, double factor) {
  if (factor == 1.0) return mesh;
  for (auto& v : mesh.vertices) v = (v.cast<double>() * factor).cast<float>();
  return mesh;
}

/// Checked before and after scaling, since a length may leave the range of a float.
void check_vertices(const TriangleMesh& mesh, const std::filesystem::path& path) {
  for (const auto& v : mesh.vertices) {
    require(v.allFinite(),
            "the mesh of '",
            path.string(),
            "' has a vertex that is not a finite point; repair the mesh");
  }
}

}  // namespace

TriangleMesh read_mesh(const std::filesystem::path& path, double unit) {
  check_unit(unit);
  TriangleMesh mesh = scaled(read_by_extension(path), unit);
  require(!mesh.empty(),
          "'",
          path.string(),
          "' holds no triangles; choose a file with a mesh, or read it as a cloud");
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t v : triangle) {
      require(v < mesh.vertices.size(),
              "a face of '",
              path.string(),
              "' names vertex ",
              v,
              " where the file has ",
              mesh.vertices.size(),
              " vertices (counted from 0); the file is torn");
    }
  }
  check_vertices(mesh, path);
  return mesh;
}

void write_mesh(const std::filesystem::path& path, const TriangleMesh& mesh, double unit) {
  check_unit(unit);
  mesh.check();
  require(!mesh.empty(),
          "the mesh for '",
          path.string(),
          "' has no triangles; nothing was written; check the steps before");
  const TriangleMesh in_unit = scaled(mesh, 1 / unit);
  check_vertices(in_unit, path);
  const std::string extension = lower_extension(path);
  if (extension == ".ply") return write_ply_mesh(path, in_unit);
  if (extension == ".obj") return write_obj_mesh(path, in_unit);
  if (extension == ".stl") return write_stl_mesh(path, in_unit);
  if (extension == ".off") return write_off_mesh(path, in_unit);
  if (extension == ".glb") {
    require(unit == 1.0, "glTF files are in metres; leave the unit out for '", path.string(), "'");
    return write_glb_mesh(path, mesh);
  }
  fail("cannot write a mesh to '",
       path.string(),
       "': expected a name that ends in .ply, .obj, .stl, .off or .glb");
}

void add_fan(TriangleMesh& mesh,
             const std::vector<std::uint32_t>& corners,
             const std::filesystem::path& path) {
  require(corners.size() >= 3,
          "a face of '",
          path.string(),
          "' has ",
          corners.size(),
          " corners; expected 3 or more");
  for (std::size_t k = 2; k < corners.size(); ++k) {
    mesh.triangles.push_back({corners[0], corners[k - 1], corners[k]});
  }
}

}  // namespace facula
