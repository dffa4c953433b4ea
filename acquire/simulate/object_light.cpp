// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/simulate/object_light.hpp>

namespace facula {

using Eigen::Vector3d;

double laser_tint(const Vector3d& colour, LaserColour laser) {
  switch (laser) {
    case LaserColour::kRed:
      return colour[0];
    case LaserColour::kGreen:
      return colour[1];
    case LaserColour::kInfrared:
      return colour.mean();
  }
  return colour.mean();
}

std::vector<ObjectLight> object_lights(const Scene& scene, const SimulateOptions& options) {
  std::vector<ObjectLight> lights;
  for (const SceneObject& object : scene.objects()) {
    const double level = object.albedo * options.ambient + object.glow;
    ObjectLight light;
    light.ambient = options.colour_frames ? Vector3d(level * object.colour.reverse())
                                          : Vector3d(level * object.colour.mean(), 0, 0);
    light.laser_share = object.albedo * laser_tint(object.colour, options.laser_colour);
    light.mirror = object.mirror;
    lights.push_back(light);
  }
  return lights;
}

// The dyes of a colour sensor let some of every colour through. Green and blue of the unsaturated
// line in the frames of caltag_turntable_pot are 0.17 to 0.39 of its red; green is taken likewise.
Vector3d laser_response(const SimulateOptions& options) {
  if (!options.colour_frames) return {1, 0, 0};
  switch (options.laser_colour) {
    case LaserColour::kRed:
      return {0.25, 0.25, 1};
    case LaserColour::kGreen:
      return {0.25, 1, 0.25};
    case LaserColour::kInfrared:
      return {1, 1, 1};
  }
  return {1, 1, 1};
}

}  // namespace facula
