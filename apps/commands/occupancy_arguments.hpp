// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/apps/cli/arguments.hpp>
#include <facula/map/occupancy_map.hpp>

#include <optional>

#include <Eigen/Core>

namespace facula {

/// The options of whatever makes occupancy maps: cells, rays and the sensor's model.
struct OccupancyArguments {
  OccupancyOptions options;                ///< but for the box
  std::optional<Eigen::Vector3d> box_min;  ///< [m]
  std::optional<Eigen::Vector3d> box_max;  ///< [m]

  /// With the box. Throws UsageError where it has one corner only, or a lowest above the highest.
  OccupancyOptions with_box() const;
};

void declare_occupancy(Arguments& arguments, OccupancyArguments& a);

}  // namespace facula
