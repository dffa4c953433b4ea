// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/triangle_mesh.hpp>
#include <facula/apps/cli/session.hpp>
#include <facula/apps/commands/demo/recorded_scan.hpp>
#include <facula/map/occupancy_map.hpp>
#include <facula/reconstruct/measure/plane.hpp>
#include <facula/reconstruct/register/register_scans.hpp>

#include <vector>

namespace facula {

/// What the road through the furnished room gave.
struct RoomDemo {
  std::vector<RecordedScan> scans;
  ScanProject project;                 ///< registered
  PointCloud planes_cloud;             ///< thinned, with normals
  std::vector<ExtractedPlane> planes;  ///< of planes_cloud
  TriangleMesh mesh;
  OccupancyMap map;
};

/// The furnished room from three stations: record, register from rough poses, measure planes, mesh,
/// map; every step is checked against the scene. Writes captures, scans, poses.toml, planes.csv,
/// room_mesh.ply, map.bt, map.ot, map.yaml and map.pgm.
RoomDemo run_room_demo(const DemoSettings& settings, Session& session);

}  // namespace facula
