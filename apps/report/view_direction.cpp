// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/apps/report/view_direction.hpp>

#include <Eigen/Geometry>

namespace facula {

Eigen::Matrix3d ViewDirection::rotation() const {
  Eigen::Matrix3d rotation;
  rotation << right.transpose(), up.transpose(), towards_viewer.transpose();
  return rotation;
}

ViewDirection front_view() {
  return {"front: x right, z up",
          Eigen::Vector3d::UnitX(),
          Eigen::Vector3d::UnitZ(),
          -Eigen::Vector3d::UnitY()};
}

ViewDirection side_view() {
  return {"side: y right, z up",
          Eigen::Vector3d::UnitY(),
          Eigen::Vector3d::UnitZ(),
          Eigen::Vector3d::UnitX()};
}

ViewDirection top_view() {
  return {"top: x right, y up",
          Eigen::Vector3d::UnitX(),
          Eigen::Vector3d::UnitY(),
          Eigen::Vector3d::UnitZ()};
}

ViewDirection oblique_view() {
  const Eigen::Vector3d towards = Eigen::Vector3d(0.55, -0.75, 0.62).normalized();
  const Eigen::Vector3d right = Eigen::Vector3d::UnitZ().cross(towards).normalized();
  return {"oblique, from above", right, towards.cross(right), towards};
}

}  // namespace facula
