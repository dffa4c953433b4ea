// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>

namespace facula {

/// How large the demo is and where it writes.
struct DemoSettings {
  std::filesystem::path folder;       ///< filled by the demo
  double room_step = 0.020943951;     ///< of the pan head between two frames, 1.2 degrees [rad]
  double object_step = 0.034906585;   ///< of the turntable between two frames, 2 degrees [rad]
  double start_distance = 0.1;        ///< error of the rough poses [m]
  double start_angle = 0.0523598776;  ///< error of the rough poses, 3 degrees [rad]
  std::uint64_t seed = 1;             ///< of noise and rough poses [1]
  int num_threads = 0;                ///< 0 = all cores [1]

  // A scan's points lie far closer along a column than across columns. Voxels as wide as the
  // columns stand apart at an ordinary distance even that out, so that neighbourhoods are round.
  double room_voxel() const { return 2.0 * room_step; }        ///< columns 2 m away [m]
  double object_voxel() const { return 0.045 * object_step; }  ///< columns 45 mm from the axis [m]
};

}  // namespace facula
