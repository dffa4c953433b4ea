// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/point_cloud.hpp>
#include <facula/apps/report/drawing.hpp>

namespace facula {

struct ScanPictureOptions {
  int panel = 400;          ///< side of one view [px], 120 to 2000
  double point_size = 2.0;  ///< [px], 1 to 20
  bool hide_backs = true;   ///< points whose normal looks away are left out (rooms open up)
  bool use_colors = true;   ///< the cloud's own colours where it has them, else by height

  void check() const;
};

/// The cloud from the front, the side and above, to one scale, shaded by depth. A cloud without
/// finite points gives a picture that says so.
Image8 scan_picture(const PointCloud& cloud, const ScanPictureOptions& options = {});

}  // namespace facula
