// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/triangle_mesh.hpp>
#include <facula/apps/cli/session.hpp>
#include <facula/apps/commands/demo/recorded_scan.hpp>

namespace facula {

/// What the road over the turntable gave.
struct ObjectDemo {
  RecordedScan scan;
  TriangleMesh mesh;
};

/// The object on the turntable: record, filter, mesh, checked against the scene. Writes the
/// capture, scans/object.pcd and object_mesh.ply.
ObjectDemo run_object_demo(const DemoSettings& settings, Session& session);

}  // namespace facula
