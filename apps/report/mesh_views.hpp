// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/triangle_mesh.hpp>
#include <facula/apps/report/drawing.hpp>

namespace facula {

struct MeshViewsOptions {
  int panel = 400;          ///< side of one view [px], 120 to 2000
  bool smooth = true;       ///< else every triangle has one shade
  bool hide_backs = false;  ///< leave out backs (rooms open up); else they are drawn in ochre
  int num_threads = 0;      ///< 0 = all cores [1]

  void check() const;
};

/// The mesh from the front, the side and obliquely from above, to one scale, with its outer
/// dimensions. A mesh without triangles gives a picture that says so.
Image8 mesh_views(const TriangleMesh& mesh, const MeshViewsOptions& options = {});

}  // namespace facula
