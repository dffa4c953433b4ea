// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>

namespace facula {

/// How large the demo is and where it writes.
struct DemoSettings {
  std::filesystem::path folder;       ///< filled by the demo
  double room_step = 0.026179939;     ///< of the pan head between two frames [rad]
  double object_step = 0.034906585;   ///< of the turntable between two frames [rad]
  double start_distance = 0.1;        ///< error of the rough poses [m]
  double start_angle = 0.0523598776;  ///< error of the rough poses [rad]
  std::uint64_t seed = 1;             ///< of noise and rough poses [1]
  int num_threads = 0;                ///< 0 = all cores [1]
};

}  // namespace facula
