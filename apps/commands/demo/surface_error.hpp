// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/triangle_mesh.hpp>
#include <facula/acquire/simulate/scene.hpp>
#include <facula/apps/cli/figures.hpp>

namespace facula {

/// Size of a mesh and the distance of its vertices (world frame) to the nearest true surface.
void report_mesh_error(const TriangleMesh& mesh,
                       const Scene& scene,
                       int num_threads,
                       Figures& figures);

}  // namespace facula
