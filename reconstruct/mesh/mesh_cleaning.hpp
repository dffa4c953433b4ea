// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/triangle_mesh.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace facula {

// Steps that make a mesh fit for use. Each takes a mesh and returns another; vertex normals are
// dropped where vertices move, colours are kept where vertices are kept.

/// What repaired() did.
struct RepairCounts {
  std::size_t bad_triangles = 0;      ///< without area, or with a corner that is not finite [1]
  std::size_t double_triangles = 0;   ///< on the same three vertices as another one [1]
  std::size_t crowded_triangles = 0;  ///< beyond the second at an edge, or turned against it [1]
  std::size_t turned_triangles = 0;   ///< turned to agree with their neighbours [1]
  std::size_t split_vertices = 0;     ///< that several fans of triangles shared [1]
};

/// An oriented manifold with boundary of the same surface as far as there is one: bad and double
/// triangles go, of more than two triangles at an edge the largest two stay, neighbours are turned
/// alike (a Moebius band is cut), vertices between several fans are doubled and drawn a twentieth
/// of an edge into their fans, so that these no longer touch; unused vertices are dropped. Each
/// piece keeps the orientation that most of its area had.
TriangleMesh repaired(const TriangleMesh& mesh, RepairCounts* counts = nullptr);

/// Which pieces (triangles joined by edges) stay.
struct IslandOptions {
  bool keep_largest = false;  ///< only the piece of the largest area
  double min_diameter = 0;    ///< pieces whose box has a shorter diagonal go [m]
  double min_area = 0;        ///< pieces of a smaller share of the largest one's area go [1]

  void check() const;
};

/// The mesh without its islands. `removed`, when given, receives how many pieces went.
TriangleMesh without_islands(const TriangleMesh& mesh,
                             const IslandOptions& options,
                             std::size_t* removed = nullptr);

/// Closes the boundary loops of a manifold whose box has a diagonal of at most `max_diameter` [m]
/// with triangles of least area, refined to the density around and faired (Liepa 2003, CGAL). The
/// longest loop of an open surface is one of them where it is short enough. Gives up on loops of
/// more than 4000 edges, and on tangled ones of more than 1000. `filled`, when given, receives how
/// many loops were closed. Throws Error where the mesh is no oriented manifold.
TriangleMesh fill_holes(const TriangleMesh& mesh,
                        double max_diameter,
                        std::size_t* filled = nullptr);

/// The mesh with edges near `edge` [m] long (Botsch and Kobbelt 2004, CGAL), projected back to the
/// surface; boundaries stay where they are. Throws Error where the mesh is no oriented manifold.
TriangleMesh remeshed(const TriangleMesh& mesh, double edge);

struct SimplifyOptions {
  std::size_t triangles = 0;  ///< stop at so many; 0 = no such bound [1]
  double max_error = 0;       ///< no vertex of the mesh farther from the result [m]; 0 = no bound
  int num_threads = 0;        ///< of the check of max_error, 0 = all cores [1]

  void check() const;
};

/// Fewer triangles by collapsing edges of least quadric error (Garland and Heckbert 1997, CGAL),
/// none turned over. An error bound is measured afterwards and kept by a finer run where it was
/// exceeded; where both bounds are given the mesh stops at the first. Throws Error where the mesh
/// is no oriented manifold.
TriangleMesh simplified(const TriangleMesh& mesh, const SimplifyOptions& options);

/// Smoothed by so many pairs of steps, one inwards and one outwards, which damps noise and keeps
/// volume (Taubin 1995: lambda 0.5, pass band 0.1); vertices of the boundary stay. 0 = unchanged.
TriangleMesh smoothed(const TriangleMesh& mesh, int steps, int num_threads = 0);

/// Removes the triangles that are marked with 1, keeps all vertices; returns how many went.
std::size_t remove_triangles(TriangleMesh& mesh, const std::vector<std::uint8_t>& marked);

/// The mesh over those of its vertices that a triangle uses.
TriangleMesh compacted(const TriangleMesh& mesh);

}  // namespace facula
