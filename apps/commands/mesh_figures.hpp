// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/triangle_mesh.hpp>
#include <facula/apps/cli/figures.hpp>

namespace facula {

/// What a mesh is made of and how closed it is, the same wherever a command speaks of a mesh.
void report_mesh(const TriangleMesh& mesh, Figures& figures);

}  // namespace facula
