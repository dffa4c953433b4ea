// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/reconstruct/mesh/streamed_ply.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <string>

namespace facula {
namespace {

static_assert(std::endian::native == std::endian::little, "the file is written as memory lies");

constexpr std::size_t kHeaderBytes = 320;

/// The header, made kHeaderBytes long by a comment, so that it can be written over in place.
std::string header(std::size_t vertices, std::size_t triangles) {
  const std::string start = "ply\nformat binary_little_endian 1.0\n";
  const std::string rest = "element vertex " + std::to_string(vertices) +
                           "\nproperty float x\nproperty float y\nproperty float z\n"
                           "element face " +
                           std::to_string(triangles) +
                           "\nproperty list uchar int vertex_indices\nend_header\n";
  const std::string word = "comment ";
  const std::size_t pad = kHeaderBytes - start.size() - rest.size() - word.size() - 1;
  return start + word + std::string(pad, '.') + "\n" + rest;
}

}  // namespace

StreamedPly::StreamedPly(const std::filesystem::path& path) : file_(path), faces_(path) {
  file_.stream() << header(0, 0);
}

void StreamedPly::add(const std::vector<Eigen::Vector3f>& vertices,
                      const std::vector<TriangleMesh::Triangle>& triangles) {
  static_assert(sizeof(Eigen::Vector3f) == 3 * sizeof(float));
  file_.stream().write(reinterpret_cast<const char*>(vertices.data()),
                       static_cast<std::streamsize>(vertices.size() * sizeof(Eigen::Vector3f)));
  constexpr std::size_t kFaceBytes = 13;
  std::vector<char> faces(kFaceBytes * triangles.size());
  char* face = faces.data();
  for (const TriangleMesh::Triangle& triangle : triangles) {
    *face = 3;
    std::memcpy(face + 1, triangle.data(), sizeof(triangle));
    face += kFaceBytes;
    const std::uint32_t highest = *std::max_element(triangle.begin(), triangle.end());
    highest_corner_ = std::max<std::size_t>(highest_corner_, highest);
  }
  faces_.stream().write(faces.data(), static_cast<std::streamsize>(faces.size()));
  vertices_ += vertices.size();
  triangles_ += triangles.size();
}

void StreamedPly::commit() {
  require(triangles_ == 0 || highest_corner_ < vertices_,
          "a triangle names vertex ",
          highest_corner_,
          " of ",
          vertices_,
          "; hand over every vertex that triangles name");
  faces_.stream().flush();
  require(faces_.stream().good(),
          "the triangles of the mesh could not be written: the disk is full");
  if (triangles_ > 0) {
    std::ifstream faces(faces_.temporary_path(), std::ios::binary);
    file_.stream() << faces.rdbuf();
  }
  file_.stream().seekp(0);
  file_.stream() << header(vertices_, triangles_);
  file_.commit();
}

}  // namespace facula
