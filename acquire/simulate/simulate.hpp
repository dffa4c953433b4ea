// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/image_view.hpp>
#include <facula/acquire/core/polar_scan.hpp>
#include <facula/acquire/core/progress.hpp>
#include <facula/acquire/rig/rig.hpp>
#include <facula/acquire/simulate/conditions.hpp>
#include <facula/acquire/simulate/scene.hpp>
#include <facula/acquire/stripe/stripe_detector.hpp>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

namespace facula {

/// The light and the sensor of the simulated head. The defaults suit a pan head in a room; see
/// options_for().
struct SimulateOptions {
  std::size_t laser = 0;    ///< index of the sheet that is lit [1]
  bool all_lasers = false;  ///< all sheets are lit at once; truth is then of `laser` only
  /// Where the laser's fan of light starts, camera frame [m]; it is moved onto the laser plane. A
  /// sheet that bows, and with all_lasers every other sheet, starts where options_for() says.
  Eigen::Vector3d laser_origin = Eigen::Vector3d(0.25, 0, 0);
  double line_half_width = 0.0008;   ///< of the sheet at the laser, 1 standard deviation [m]
  double line_divergence = 0.0025;   ///< growth of the half width with distance [rad]
  std::optional<GaussianBeam> beam;  ///< takes the place of line_half_width and line_divergence
  double laser_peak = 170;           ///< signal of a white wall square to the light 1 m away [DN]
  /// Power of (1 m / distance to the laser) that the light follows beside the widening of the
  /// sheet: 1 for a fan and a linear sensor, 0 for a head that evens it out by its exposure [1].
  double exposure_falloff = 0;
  double ambient = 6;       ///< signal of a white surface in ambient light [DN]
  double read_noise = 1.5;  ///< 1 standard deviation [DN]
  double shot_noise = 0.1;  ///< variance per DN of signal [DN]
  double black_level = 4;   ///< [DN]
  LaserColour laser_colour = LaserColour::kRed;
  bool colour_frames = false;  ///< deliver blue-green-red frames instead of grey ones
  std::optional<Speckle> speckle;
  Lens lens;
  MainsFlicker flicker;
  Timing timing;
  AxisErrors axis_errors;
  double stripe_noise = 0.1;       ///< of simulate_profile()'s positions, 1 std. deviation [px]
  bool background_frames = false;  ///< also deliver the frame with the laser off, taken before
  bool second_background = false;  ///< and another one, taken after
  std::uint64_t seed = 1;          ///< [1]
  int num_threads = 0;             ///< 0 = all cores [1]
  Progress progress;               ///< called per frame; may be empty

  /// Throws Error naming the field, its value and its bound.
  void check() const;
};

/// Options that suit a rig and its first sheet. The working distance is where the sheet crosses the
/// camera's axis (four baselines where it does not); there the line is 2 px wide (1 standard
/// deviation) and a white wall gives 170 DN. The laser stands beside the camera, in the camera
/// frame's plane z = 0. Far away the line narrows to 1.5 px. On a turntable the light falls off
/// with distance as a fan does; other heads see from near to far and even it out (exposure_falloff
/// 0).
SimulateOptions options_for(const Rig& rig);

/// One frame as the camera would deliver it, 8-bit grey or colour: per pixel, rays over the pixel's
/// area meet the scene; each adds ambient light and, where the laser sees the point, the sheet's
/// Gaussian irradiance; then lens and speckle, shot and read noise, black level, 8-bit
/// quantisation. `frame` numbers the noise and counts the time. On a turntable the scene's objects
/// turn with the table: there the camera's pose in the turning scan frame is given, world_from_scan
/// * Axis::scan_from_camera_at(position), and the scene stays. Ambient light is the same from all
/// sides, so this shows the same image. A scene that holds things beside the table will see them
/// turn as well.
Image8 simulate_frame(const Scene& scene,
                      const Rig& rig,
                      const RigidTransform& world_from_camera,
                      bool laser_on,
                      std::uint64_t frame,
                      const SimulateOptions& options);

/// The truth, from the scene and not from the image: per image row and position the point where the
/// middle of the sheet lights a surface that the camera sees in the middle of that row (the
/// brightest where there are several), in the scan frame. Rows are image columns where the stripe
/// runs per column. sigma is 0; intensity is the signal there over 255, at most 1.
PolarScan true_scan(const Scene& scene,
                    const Rig& rig,
                    const RigidTransform& world_from_scan,
                    const std::vector<double>& positions,
                    const SimulateOptions& options);

/// The stripe of one frame without the frame: where the truth of each row projects to, plus
/// Gaussian noise of stripe_noise, as a detector with just that error would report it. For studies
/// of what comes after detection; thousands of times faster than images. Each row's noise is
/// independent; `frame` numbers it.
StripeProfile simulate_profile(const Scene& scene,
                               const Rig& rig,
                               const RigidTransform& world_from_camera,
                               std::uint64_t frame,
                               const SimulateOptions& options);

/// A simulated run of the head.
struct SimulatedRun {
  RigidTransform world_from_scan;  ///< where the head (or the table) stands
  std::vector<double> positions;   ///< axis programme [rad or m]
};

/// Writes a capture: capture.toml, rig.toml, positions.csv, frames/NNNN.png (and
/// background/NNNN.png, background_after/NNNN.png), truth.pcd. read_capture() reads it back. Frames
/// do not depend on the number of threads. positions.csv holds the programme; with axis_errors the
/// frames and the truth stand where the axis went instead, dark frames where it was when they were
/// taken.
void simulate_capture(const std::filesystem::path& folder,
                      const Scene& scene,
                      const Rig& rig,
                      const SimulatedRun& run,
                      const SimulateOptions& options);

}  // namespace facula
