// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/capture/capture.hpp>
#include <facula/acquire/core/triangle_mesh.hpp>
#include <facula/acquire/simulate/scene.hpp>
#include <facula/apps/cli/figures.hpp>
#include <facula/reconstruct/register/scan_project.hpp>

namespace facula {

// What facula info says about each kind of file.
void describe(const Rig& rig, Figures& figures);
void describe(const Scene& scene, Figures& figures);
void describe(const Capture& capture, Figures& figures);
void describe(const ScanProject& project, Figures& figures);
void describe(const PolarScan& scan, Figures& figures);
void describe(const PointCloud& cloud, Figures& figures);
void describe(const TriangleMesh& mesh, Figures& figures);

}  // namespace facula
