// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/triangle_mesh.hpp>
#include <facula/apps/cli/figures.hpp>
#include <facula/apps/commands/demo/demo_settings.hpp>
#include <facula/reconstruct/register/scan_project.hpp>

namespace facula {

/// The mesh that `facula mesh` makes of these scans without options: method and why, small pieces
/// removed; the figures get the method's reason and what is true of the mesh.
TriangleMesh mesh_demo_scans(const ScanProject& project,
                             const DemoSettings& settings,
                             Figures& figures);

}  // namespace facula
