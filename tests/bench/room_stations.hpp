// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/reconstruct/register/scan_project.hpp>

#include <vector>

namespace facula {

/// A project whose poses are known; the scans themselves stand at the identity.
struct KnownProject {
  ScanProject project;
  std::vector<RigidTransform> truth;  ///< world_from_scan
};

/// Eight places at least half a metre clear of everything in data/scenes/furnished_room.toml, heads
/// plumb.
std::vector<RigidTransform> room_stations();

/// What the simulated head sees from there: frames every `step` [rad], extracted, without mixed
/// points.
KnownProject eight_stations(double step);

}  // namespace facula
