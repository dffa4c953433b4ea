// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/image_view.hpp>
#include <facula/acquire/core/polar_scan.hpp>
#include <facula/acquire/core/progress.hpp>
#include <facula/acquire/rig/rig.hpp>
#include <facula/acquire/simulate/scene.hpp>

#include <cstdint>
#include <filesystem>
#include <vector>

namespace facula {

/// The light and the sensor of the simulated head.
struct SimulateOptions {
  /// Where the laser's fan of light starts, camera frame [m]; it is moved onto the laser plane.
  Eigen::Vector3d laser_origin = Eigen::Vector3d(0.25, 0, 0);
  double line_half_width = 0.0006;  ///< of the sheet at the laser, 1 standard deviation [m]
  double line_divergence = 0.0008;  ///< growth of the half width with distance [rad]
  double laser_peak = 160;          ///< signal of a white wall square to the light 1 m away [DN]
  double exposure_falloff =
      1;                    ///< power of (1 m / distance to the laser) that the light follows [1]
  double ambient = 6;       ///< signal of a white surface in ambient light [DN]
  double read_noise = 1.5;  ///< 1 standard deviation [DN]
  double shot_noise = 0.1;  ///< variance per DN of signal [DN]
  double black_level = 4;   ///< [DN]
  double axis_noise = 0;    ///< position error of the axis, 1 standard deviation [rad or m]
  bool background_frames = false;  ///< also deliver the frame with the laser off
  std::uint64_t seed = 1;          ///< [1]
  int num_threads = 0;             ///< 0 = all cores [1]
  Progress progress;               ///< called per frame; may be empty

  void check() const;
};

/// One frame as the camera would deliver it, 8-bit grey: per pixel, rays over the pixel's area meet
/// the scene; each adds ambient light and, where the laser sees the point, the sheet's Gaussian
/// irradiance; then shot and read noise, black level, 8-bit quantisation. `frame` numbers the
/// noise. `world_from_scan` places the head; for a turntable the scene's objects turn with the
/// table.
Image8 simulate_frame(const Scene& scene,
                      const Rig& rig,
                      const RigidTransform& world_from_camera,
                      bool laser_on,
                      std::uint64_t frame,
                      const SimulateOptions& options);

/// The truth, from the scene and not from the image: per image row and position the point where the
/// middle of the sheet lights a surface that the camera sees in the middle of that row (the
/// brightest where there are several), in the scan frame. sigma is 0, intensity the irradiance.
PolarScan true_scan(const Scene& scene,
                    const Rig& rig,
                    const RigidTransform& world_from_scan,
                    const std::vector<double>& positions,
                    const SimulateOptions& options);

/// A simulated run of the head.
struct SimulatedRun {
  RigidTransform world_from_scan;  ///< where the head (or the table) stands
  std::vector<double> positions;   ///< axis programme [rad or m]
};

/// Writes a capture: capture.toml, rig.toml, frames/NNNN.png (and background/NNNN.png), truth.pcd.
/// read_capture() reads it back. Frames do not depend on the number of threads.
void simulate_capture(const std::filesystem::path& folder,
                      const Scene& scene,
                      const Rig& rig,
                      const SimulatedRun& run,
                      const SimulateOptions& options);

}  // namespace facula
