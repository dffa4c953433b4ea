// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/triangle_mesh.hpp>

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace facula {

/// One rim of a mesh.
struct BoundaryLoop {
  std::size_t edges = 0;  ///< [1]
  double length = 0;      ///< [m]
  double diameter = 0;    ///< of its box, corner to corner [m]
};

/// How far points lie from a mesh; points that are not finite are left out.
struct MeshDeviation {
  std::size_t points = 0;  ///< [1]
  double median = 0;       ///< [m]
  double p95 = 0;          ///< 95 of 100 lie at or below [m]
  double max = 0;          ///< [m]
};

/// What may be said of a mesh before it is handed on.
struct MeshVerdict {
  MeshStatistics statistics;
  std::vector<BoundaryLoop> loops;        ///< longest first
  std::size_t non_manifold_vertices = 0;  ///< where several fans of triangles touch [1]
  std::size_t turned_edges = 0;           ///< whose two triangles are turned against each other [1]
  std::size_t triangles_without_area = 0;  ///< corners equal or exactly on one line [1]
  std::size_t self_intersections = 0;      ///< pairs of triangles that cut or touch where they
                                           ///< should not, judged exactly [1]
  bool closed = false;                     ///< no boundary edge, and there are triangles
  bool manifold = false;                   ///< around every edge and vertex, turned consistently
  std::optional<long> genus;               ///< handles of a closed manifold, over all pieces [1]
  std::optional<double> volume;            ///< if closed and manifold [m^3]
  std::optional<MeshDeviation> deviation;  ///< of points from it, where points were given

  /// Closed, manifold, without self-intersection or degenerate triangle, and of positive volume.
  bool watertight() const;

  /// One sentence: "closed and manifold, no self-intersections" or what is wrong.
  std::string sentence() const;
};

/// Judges a mesh: topology, exact self-intersections, and the deviation of `points` from it where
/// there are any. Takes any mesh, also empty or with bad vertices; throws Error when a triangle
/// names a vertex that is not there.
MeshVerdict judge_mesh(const TriangleMesh& mesh,
                       const std::vector<Eigen::Vector3f>& points = {},
                       int num_threads = 0);

/// Pairs of triangles (lower number first, sorted) that meet elsewhere than in the vertices and
/// edges they share. Exact for the given coordinates; triangles without area are left out.
std::vector<std::array<std::uint32_t, 2>> self_intersections(const TriangleMesh& mesh,
                                                             int num_threads = 0);

/// 1 for every triangle that has two equal corners or all three exactly on a line, or a corner
/// that is not finite.
std::vector<std::uint8_t> triangles_without_area(const TriangleMesh& mesh);

/// How far the finite ones of the points lie from the mesh. Throws Error when it has no surface.
MeshDeviation deviation_from_mesh(const std::vector<Eigen::Vector3f>& points,
                                  const TriangleMesh& mesh,
                                  int num_threads = 0);

}  // namespace facula
