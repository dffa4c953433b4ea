// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/point_cloud.hpp>
#include <facula/acquire/core/triangle_mesh.hpp>
#include <facula/reconstruct/mesh/mesh_verdict.hpp>

#include <string>

namespace facula {

struct WatertightOptions {
  double least_piece = 0.01;  ///< pieces of a smaller share of the largest one's area go [1]
  int rounds = 6;             ///< of cutting out and filling again where triangles cut [1]
  bool allow_wrap = true;     ///< an alpha wrap where filling holes does not get there
  double wrap_alpha = 0;      ///< of that wrap [m]; 0 = 3 times the mean edge
  int num_threads = 0;        ///< 0 = all cores [1]

  void check() const;
};

struct WatertightResult {
  TriangleMesh mesh;
  MeshVerdict verdict;             ///< of the mesh as it is handed over; watertight() holds
  std::string how;                 ///< one sentence: what was done
  std::size_t holes_filled = 0;    ///< [1]
  std::size_t pieces_removed = 0;  ///< [1]
  std::size_t triangles_cut = 0;   ///< removed because they cut others [1]
  bool wrapped = false;            ///< the mesh is a wrap, an offset outside of the surface
};

/// A closed, manifold mesh without self-intersections of the same surface, verified by
/// judge_mesh(): repaired, small pieces removed, every hole filled, triangles that cut each other
/// cut out with their neighbours and filled again; an alpha wrap where that does not get there or
/// eats up the surface. Throws Error saying what remains wrong when nothing passes. `points`, when
/// not empty, are what the deviation in the verdict is measured of.
WatertightResult make_watertight(const TriangleMesh& mesh,
                                 const std::vector<Eigen::Vector3f>& points = {},
                                 const WatertightOptions& options = {});

}  // namespace facula
