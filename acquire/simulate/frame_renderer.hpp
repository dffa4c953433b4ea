// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/image_view.hpp>
#include <facula/acquire/simulate/laser_layer.hpp>
#include <facula/acquire/simulate/light_path.hpp>
#include <facula/acquire/simulate/object_light.hpp>
#include <facula/acquire/simulate/ray_table.hpp>
#include <facula/acquire/simulate/simulate.hpp>

#include <cstdint>
#include <vector>

namespace facula {

/// One exposure of a run. Each step of the axis takes up to three: dark, lit, dark again.
struct Exposure {
  bool laser_on = true;
  std::uint64_t step = 0;  ///< of the axis [1]
  bool after = false;      ///< a dark one: the second, after the lit one
};

/// Renders the frames of one head: keeps the camera's table of rays between frames. Calls may run
/// from several threads. Scene, rig and options are referred to and must outlive the renderer.
class FrameRenderer {
 public:
  FrameRenderer(const Scene& scene, const Rig& rig, const SimulateOptions& options);

  /// The light that falls on every pixel, before black level, noise, and rounding [DN]; of the
  /// exposure of step 0.
  Image<double> expected_signal(const RigidTransform& world_from_camera, bool laser_on) const;
  Image<double> expected_signal(const RigidTransform& world_from_camera,
                                const Exposure& exposure) const;

  /// As simulate_frame() describes it.
  Image8 render(const RigidTransform& world_from_camera, bool laser_on, std::uint64_t frame) const;
  Image8 render(const RigidTransform& world_from_camera, const Exposure& exposure) const;

  /// When the middle of an exposure's first row is taken [s].
  double time_of(const Exposure& exposure) const;

 private:
  struct Light {
    Image<double> ambient;  // of every channel
    LaserLayer laser;       // as the channel sees it that sees it best
  };
  Light gather(const RigidTransform& world_from_camera, bool laser_on) const;
  void flicker(Image<double>& ambient, const Exposure& exposure) const;

  const Scene& scene_;
  const SimulateOptions& options_;
  std::vector<LaserFan> fans_;
  RayTable rays_;
  std::vector<ObjectLight> objects_;
  std::vector<MirrorFace> mirrors_;
};

}  // namespace facula
