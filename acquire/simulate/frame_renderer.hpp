// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/image_view.hpp>
#include <facula/acquire/simulate/laser_fan.hpp>
#include <facula/acquire/simulate/ray_table.hpp>
#include <facula/acquire/simulate/simulate.hpp>

#include <cstdint>
namespace facula {

/// Renders the frames of one head: keeps the camera's table of rays between frames. Calls may run
/// from several threads. Scene, rig and options are referred to and must outlive the renderer.
class FrameRenderer {
 public:
  FrameRenderer(const Scene& scene, const Rig& rig, const SimulateOptions& options);

  /// The light that falls on every pixel, before black level, noise, and rounding [DN].
  Image<double> expected_signal(const RigidTransform& world_from_camera, bool laser_on) const;

  /// As simulate_frame() describes it.
  Image8 render(const RigidTransform& world_from_camera, bool laser_on, std::uint64_t frame) const;

 private:
  class Pass;

  const Scene& scene_;
  const SimulateOptions& options_;
  LaserFan fan_;
  RayTable rays_;
};

}  // namespace facula
