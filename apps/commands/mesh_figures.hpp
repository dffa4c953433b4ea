// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/triangle_mesh.hpp>
#include <facula/apps/cli/figures.hpp>
#include <facula/reconstruct/mesh/mesh_verdict.hpp>

namespace facula {

/// The verdict on a mesh, the same wherever a command speaks of a mesh.
void report_mesh(const TriangleMesh& mesh, Figures& figures);
void report_verdict(const MeshVerdict& verdict, Figures& figures);

}  // namespace facula
