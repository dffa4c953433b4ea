// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/apps/commands/map_pose.hpp>

namespace facula {

void declare_map_pose(Arguments& arguments, MapPoseArguments& a) {
  arguments.vector("--position-mm",
                   a.position,
                   kMillimetres,
                   "where the second map's origin lies in the first map");
  arguments.vector("--rotation-deg",
                   a.rotation,
                   kDegrees,
                   "how the second map is turned there, about x, then y, then z");
}

RigidTransform pose_of(const MapPoseArguments& a) {
  RigidTransform pose;
  pose.rotation = Eigen::AngleAxisd(a.rotation.z(), Eigen::Vector3d::UnitZ()) *
                  Eigen::AngleAxisd(a.rotation.y(), Eigen::Vector3d::UnitY()) *
                  Eigen::AngleAxisd(a.rotation.x(), Eigen::Vector3d::UnitX());
  pose.translation = a.position;
  return pose;
}

}  // namespace facula
