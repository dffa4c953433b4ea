// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/reconstruct/register/scan_project.hpp>

#include <cstdint>

namespace facula {

struct SimulatedPairOptions {
  std::uint64_t seed = 1;
  int rows = 90;          ///< rays up and down, over 100 degrees [1]
  int cols = 240;         ///< rays around [1]
  double sigma = 0.003;   ///< of a range, normal [m]
  double distance = 1.0;  ///< between the two stands [m]
};

/// Two scans of one room, with what is true about them.
struct SimulatedPair {
  PosedCloud source;
  PosedCloud target;
  RigidTransform target_from_source;  ///< true
};

/// A room of random size with random boxes, balls and pillars, seen from two random stands with
/// random headings. Every ray meets the closed form of the surfaces, its range gets normal noise:
/// nothing here is shared with registration. Scans know their sigmas and sensor origins.
SimulatedPair simulate_pair(const SimulatedPairOptions& options = {});

}  // namespace facula
