// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/rigid_transform.hpp>
#include <facula/apps/cli/arguments.hpp>

namespace facula {

/// Where one map stands in another's frame, as it is typed.
struct MapPoseArguments {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< of the second map's origin [m]
  Eigen::Vector3d rotation =
      Eigen::Vector3d::Zero();  ///< about the first map's x, then y, then z axis [rad]
};

void declare_map_pose(Arguments& arguments, MapPoseArguments& a);

/// The pose first_from_second.
RigidTransform pose_of(const MapPoseArguments& a);

}  // namespace facula
