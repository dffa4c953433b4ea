// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/median.hpp>
#include <facula/acquire/simulate/frame_renderer.hpp>
#include <facula/tests/bench/accuracy/thin_line.hpp>

#include <algorithm>

namespace facula {

void expose(SimulateOptions& light,
            const Scene& scene,
            const Rig& rig,
            const std::vector<RigidTransform>& world_from_camera) {
  constexpr double kHeight = 150;   // [DN]
  constexpr double kLeast = 0.001;  // of the default's height: no line in this row
  const FrameRenderer renderer(scene, rig, light);
  std::vector<double> heights;
  for (const RigidTransform& pose : world_from_camera) {
    const Image<double> lit = renderer.expected_signal(pose, true);
    const Image<double> dark = renderer.expected_signal(pose, false);
    for (int r = 0; r < lit.rows; ++r) {
      double height = 0;
      for (int c = 0; c < lit.cols; ++c) height = std::max(height, lit.row(r)[c] - dark.row(r)[c]);
      if (height > kLeast * kHeight) heights.push_back(height);
    }
  }
  if (!heights.empty()) light.laser_peak *= kHeight / median(heights);
}

}  // namespace facula
