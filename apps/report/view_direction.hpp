// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <string>

#include <Eigen/Core>

namespace facula {

/// An orthographic view: three unit vectors at right angles, right = up x towards_viewer.
struct ViewDirection {
  std::string name;
  Eigen::Vector3d right = Eigen::Vector3d::UnitX();
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  Eigen::Vector3d towards_viewer = -Eigen::Vector3d::UnitY();

  /// view_from_scene: rows right, up, towards_viewer.
  Eigen::Matrix3d rotation() const;
};

ViewDirection front_view();    ///< x to the right, z up, seen along y
ViewDirection side_view();     ///< y to the right, z up, seen against x
ViewDirection top_view();      ///< x to the right, y up, seen from above
ViewDirection oblique_view();  ///< from the front, right and above

}  // namespace facula
