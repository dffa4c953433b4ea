// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/rig/rig.hpp>
#include <facula/acquire/simulate/scene.hpp>
#include <facula/acquire/simulate/simulate.hpp>

#include <cmath>
#include <utility>
#include <vector>

namespace facula {

/// A head that does not move, so that scan, camera and world frame are one: z ahead, y down. The
/// sheet stands upright 0.25 m beside the camera and crosses its axis 2 m ahead.
inline Rig small_head() {
  Rig rig;
  rig.camera = {.width = 240, .height = 120, .fx = 600, .fy = 600, .cx = 119.5, .cy = 59.5};
  LaserPlane sheet;
  const double normal_z = 0.125;  // 0.25 m of distance over 2 m
  sheet.normal = {std::sqrt(1 - normal_z * normal_z), 0, normal_z};
  sheet.distance = 0.25;
  rig.lasers.push_back(sheet);
  return rig;
}

/// Options of that head without any noise.
inline SimulateOptions quiet_options(const Rig& rig) {
  SimulateOptions options = options_for(rig);
  options.read_noise = 0;
  options.shot_noise = 0;
  options.ambient = 0;
  options.black_level = 0;
  return options;
}

inline SceneObject box_at(const Eigen::Vector3d& centre, const Eigen::Vector3d& size) {
  SceneObject box;
  box.name = "box";
  box.shape = BoxShape{size};
  box.world_from_object.translation = centre;
  box.albedo = 0.8;
  return box;
}

/// A wall whose face stands square to the z axis at `depth` [m].
inline SceneObject wall_at(double depth) {
  return box_at({0, 0, depth + 0.5}, {20, 20, 1});
}

inline Scene scene_with(std::vector<SceneObject> objects) {
  return Scene(std::move(objects));
}

}  // namespace facula
