// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/simulate/simulate.hpp>

#include <cmath>
#include <numbers>
#include <vector>

namespace facula {

/// A line of 1 mm (1/e^2 diameter) that the lens blurs to 1.5 px: what a focused line laser and a
/// board camera's lens give. White walls at `distance` [m] from the laser show about 150 DN.
inline SimulateOptions thin_line_light(const Rig& rig, double distance) {
  SimulateOptions light = options_for(rig);
  light.beam = GaussianBeam{.waist = 500e-6, .focus = distance};
  light.lens.blur = 1.5;
  light.exposure_falloff = 0;
  // The lens spreads a line of standard deviation s over sqrt(s^2 + blur^2): its top falls alike.
  const double s =
      std::hypot(rig.camera.fx * light.beam->half_width(distance) / distance, 1 / std::sqrt(12.0));
  const double narrower = light.beam->half_width(distance) / light.beam->half_width(1);
  light.laser_peak = 150 * narrower * std::hypot(s, light.lens.blur) / s / 0.8;
  return light;
}

/// Sets the exposure as a user would: the line's height, in the middle of all rows that show it
/// from these places of the camera, becomes 150 DN.
void expose(SimulateOptions& light,
            const Scene& scene,
            const Rig& rig,
            const std::vector<RigidTransform>& world_from_camera);

/// Read noise that leaves `sigma` px to each row for a line of 150 DN and 1.55 px [DN].
inline double noise_for(double sigma) {
  return sigma * 150 / std::sqrt(2 * 1.55 / std::sqrt(std::numbers::pi));
}

}  // namespace facula
