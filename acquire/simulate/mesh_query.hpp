// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/triangle_mesh.hpp>

#include <memory>
#include <vector>

#include <Eigen/Core>

namespace facula {

/// How far from a mesh a point lies and whether within it. Queries may run from several threads.
class MeshQuery {
 public:
  MeshQuery(std::vector<Eigen::Vector3d> vertices, std::vector<TriangleMesh::Triangle> triangles);
  ~MeshQuery();
  MeshQuery(const MeshQuery&) = delete;
  MeshQuery& operator=(const MeshQuery&) = delete;

  /// To the nearest triangle [m]; double precision.
  double distance(const Eigen::Vector3d& x) const;

  /// By counting the crossings of rays; meaningful for a closed mesh.
  bool inside(const Eigen::Vector3d& x) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace facula
