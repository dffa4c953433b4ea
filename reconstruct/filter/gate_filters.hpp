// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/point_cloud.hpp>
#include <facula/acquire/core/rigid_transform.hpp>
#include <facula/reconstruct/filter/filter_verdict.hpp>

#include <limits>

namespace facula {

struct RangeGate {
  double nearest = 0;                                         ///< to the sensor [m], 0 or more
  double farthest = std::numeric_limits<double>::infinity();  ///< to the sensor [m]

  void check() const;
};

/// Removes points nearer to or farther from their sensor origin (the frame's origin where there is
/// none) than the gate allows, and points that are not finite.
FilterVerdict outside_range(const PointCloud& cloud, const RangeGate& gate);

/// Between two levels of the world, as to part an object from the table it stands on.
struct HeightGate {
  double lowest = -std::numeric_limits<double>::infinity();  ///< z in the world [m]
  double highest = std::numeric_limits<double>::infinity();  ///< z in the world [m]

  void check() const;
};

/// Removes points below or above the gate in the world, and points that are not finite.
FilterVerdict outside_height(const PointCloud& cloud,
                             const HeightGate& gate,
                             const RigidTransform& world_from_cloud = {});

/// Removes points whose normal and line of sight differ by more than `max_incidence` [rad], above 0
/// and at most pi/2. There a stripe is smeared and a range error is worth 1 / cos of it. The cloud
/// must have normals; zero normals are taken for unknown and kept.
FilterVerdict steeper_than(const PointCloud& cloud, double max_incidence);

}  // namespace facula
