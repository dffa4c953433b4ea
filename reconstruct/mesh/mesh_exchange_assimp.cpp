// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/mesh_file.hpp>
#include <facula/acquire/core/number_column.hpp>
#include <facula/acquire/core/whole_file.hpp>
#include <facula/reconstruct/mesh/mesh_exchange.hpp>

#include <algorithm>
#include <cmath>

#include <assimp/Importer.hpp>
#include <assimp/scene.h>

namespace facula {
namespace {

std::uint32_t word_at(const std::string& bytes, std::size_t at) {
  return static_cast<std::uint32_t>(decode_number(bytes.data() + at, NumberType::kUint32, false));
}

/// assimp reads past the end of torn files, so lengths are checked before it sees them.
void check_glb(const std::string& bytes, const std::filesystem::path& path) {
  require(bytes.size() >= 20 && bytes.starts_with("glTF") && word_at(bytes, 4) == 2,
          "'",
          path.string(),
          "' is no binary glTF 2.0 file; expected a .glb");
  bool whole = word_at(bytes, 8) == bytes.size();
  std::size_t at = 12;
  while (whole && at < bytes.size()) {
    whole = at + 8 <= bytes.size() && word_at(bytes, at) <= bytes.size() - at - 8;
    if (whole) at += 8 + word_at(bytes, at);
  }
  require(whole, "'", path.string(), "' is a torn glTF file; copy it again");
}

/// The light of a screen from linear light (IEC 61966-2-1).
std::uint8_t screen_light(float linear) {
  const double c = std::clamp(double(linear), 0.0, 1.0);
  const double screen = c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1 / 2.4) - 0.055;
  return static_cast<std::uint8_t>(std::lround(255 * screen));
}

/// y up becomes z up.
Eigen::Vector3f z_up(const aiVector3D& v) {
  return {v.x, -v.z, v.y};
}

/// Adds a mesh of the scene, moved by its node's transform.
void add_part(const aiMesh& part, const aiMatrix4x4& transform, TriangleMesh& mesh) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  const aiMatrix3x3 turn(transform);
  for (unsigned i = 0; i < part.mNumVertices; ++i) {
    mesh.vertices.push_back(z_up(transform * part.mVertices[i]));
    if (part.HasNormals()) mesh.normals.push_back(z_up(turn * part.mNormals[i]));
    if (part.HasVertexColors(0)) {
      const aiColor4D& c = part.mColors[0][i];
      mesh.colors.push_back({screen_light(c.r), screen_light(c.g), screen_light(c.b)});
    }
  }
  for (unsigned i = 0; i < part.mNumFaces; ++i) {
    const aiFace& face = part.mFaces[i];
    for (unsigned k = 2; k < face.mNumIndices; ++k) {
      mesh.triangles.push_back(
          {first + face.mIndices[0], first + face.mIndices[k - 1], first + face.mIndices[k]});
    }
  }
}

void add_node(const aiScene& scene,
              const aiNode& node,
              const aiMatrix4x4& parent,
              TriangleMesh& mesh) {
  const aiMatrix4x4 transform = parent * node.mTransformation;
  for (unsigned i = 0; i < node.mNumMeshes; ++i) {
    add_part(*scene.mMeshes[node.mMeshes[i]], transform, mesh);
  }
  for (unsigned i = 0; i < node.mNumChildren; ++i) {
    add_node(scene, *node.mChildren[i], transform, mesh);
  }
}

}  // namespace

TriangleMesh read_glb_mesh(const std::filesystem::path& path) {
  const std::string bytes = read_whole_file(path);
  check_glb(bytes, path);
  Assimp::Importer importer;
  const aiScene* scene = importer.ReadFileFromMemory(bytes.data(), bytes.size(), 0, "glb");
  require(scene != nullptr && scene->mRootNode != nullptr,
          "the glTF file '",
          path.string(),
          "' could not be read: ",
          importer.GetErrorString());
  TriangleMesh mesh;
  add_node(*scene, *scene->mRootNode, aiMatrix4x4(), mesh);
  if (mesh.normals.size() != mesh.vertices.size()) mesh.normals.clear();
  if (mesh.colors.size() != mesh.vertices.size()) mesh.colors.clear();
  require(!mesh.empty(), "'", path.string(), "' holds no triangles; choose a file with a mesh");
  mesh.check();
  for (const Eigen::Vector3f& v : mesh.vertices) {
    require(v.allFinite(),
            "the mesh of '",
            path.string(),
            "' has a vertex that is not a finite point; repair the mesh");
  }
  return mesh;
}

TriangleMesh read_any_mesh(const std::filesystem::path& path) {
  return lower_extension(path) == ".glb" ? read_glb_mesh(path) : read_mesh(path);
}

}  // namespace facula
