// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/atomic_file.hpp>
#include <facula/acquire/core/triangle_mesh.hpp>

#include <cstddef>
#include <filesystem>
#include <vector>

namespace facula {

/// A binary PLY mesh written piece by piece, for meshes larger than the memory. Triangles wait in a
/// file beside it until all vertices have come.
class StreamedPly {
 public:
  /// Throws Error as AtomicFile does.
  explicit StreamedPly(const std::filesystem::path& path);

  /// Adds vertices, and triangles between vertices counted from the first of the file.
  void add(const std::vector<Eigen::Vector3f>& vertices,
           const std::vector<TriangleMesh::Triangle>& triangles);

  /// Puts the file together and gives it its name. Throws Error when the disk is full, or when a
  /// triangle names a vertex that never came.
  void commit();

 private:
  AtomicFile file_;
  AtomicFile faces_;
  std::size_t vertices_ = 0;
  std::size_t triangles_ = 0;
  std::size_t highest_corner_ = 0;
};

}  // namespace facula
