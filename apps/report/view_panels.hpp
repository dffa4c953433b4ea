// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/apps/report/drawing.hpp>
#include <facula/apps/report/view_direction.hpp>

#include <string>
#include <vector>

#include <Eigen/Geometry>

namespace facula {

/// Orthographic views side by side, all to one scale.
struct ViewPanels {
  std::vector<ViewDirection> views;
  std::vector<Eigen::Vector3d> centers;  ///< of the scene, in the middle of each panel [m]
  double pixels_per_metre = 1;           ///< [px/m]
  int rows = 0;                          ///< of a panel [px]
  int cols = 0;                          ///< of a panel [px]
};

/// Panels `size` px wide and at most as high, in which all that is seen has room: `seen` holds one
/// box per view, along its right, up and towards_viewer [m].
ViewPanels fit_panels(const std::vector<ViewDirection>& views,
                      const std::vector<Eigen::AlignedBox3d>& seen,
                      int size);

/// The panels' pictures under their names, with a scale bar and a remark below.
Image8 join_panels(const ViewPanels& panels,
                   const std::vector<Image8>& pictures,
                   const std::string& remark);

/// "120 x 80.0 x 45.2 mm": the sides of a box along x, y and z.
std::string box_dimensions(const Eigen::AlignedBox3d& box);

/// A picture of half the size: every pixel the mean of four.
Image8 halved(const Image8& picture);

}  // namespace facula
