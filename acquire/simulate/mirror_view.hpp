// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/simulate/light_pass.hpp>

namespace facula {

/// What the camera sees in mirrors: one reflection; a mirror seen in a mirror shows its own colour
/// only.
class MirrorView {
 public:
  /// Both are referred to; `paths` is empty while the laser is off.
  MirrorView(const LightSetting& setting, const std::vector<LightPath>& paths);

  /// Adds what a pixel shows by way of a mirror, as LightPass::add_row() does.
  void add_pixel(int r, int c, int channels, double* ambient, LaserLayer& laser) const;

 private:
  const LightSetting& setting_;
  const std::vector<LightPath>& paths_;
  RigidTransform camera_from_world_;
};

}  // namespace facula
