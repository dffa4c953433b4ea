// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/rig/axis.hpp>
#include <facula/acquire/rig/camera.hpp>
#include <facula/acquire/rig/laser_plane.hpp>

#include <string>
#include <vector>

namespace facula {

/// Which way the stripe runs in the image.
enum class StripeDirection {
  kPerRow,    ///< roughly upright: one position per image row
  kPerColumn  ///< roughly level: one position per image column
};

/// A scanner head: camera, one or more sheets of light, and an axis. Lengths in metres here; in
/// rig.toml the unit stands in the key (_mm, _deg, _px).
struct Rig {
  std::string name = "rig";
  Camera camera;
  std::vector<LaserPlane> lasers;  ///< at least one, each with a name of its own
  Axis axis;
  StripeDirection stripe_direction = StripeDirection::kPerRow;

  /// Throws Error naming the first value that cannot be.
  void check() const;
};

}  // namespace facula
