// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/image_view.hpp>
#include <facula/acquire/core/point_cloud.hpp>
#include <facula/acquire/core/polar_scan.hpp>

#include <vector>

namespace facula {

/// Whether FACULA_BENCH_SMALL is set: everything runs once on little data, only to see that it
/// runs.
bool small_run();

/// Rays of a scan of the room: 500 000 unless asked otherwise.
struct RoomGrid {
  int rows = 500;
  int cols = 1000;
};

/// A closed-form room of 8 x 6 x 3 m with four boxes, seen by a head that turns once. Ranges with 2
/// mm noise, origin in the middle of the head. `stand` is 0, 1 or 2: three places, each turned
/// differently. In a small run a hundredth of the rays.
PolarScan room_scan(int stand, const RoomGrid& grid = {});

/// The scan in the room's frame, seen from a single origin.
PointCloud room_cloud(int stand, const RoomGrid& grid = {});

/// Grey frames with an upright Gaussian line (2 px, 120 DN) over noise of 2 DN; the line bends and
/// moves from frame to frame.
std::vector<Image8> stripe_frames(int rows, int cols, int count);

}  // namespace facula
