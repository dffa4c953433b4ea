// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/triangle_mesh.hpp>
#include <facula/apps/report/view_direction.hpp>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include <Eigen/Core>

namespace facula {

/// Where an orthographic picture is taken.
struct RasterView {
  ViewDirection direction;
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  ///< shown in the middle of the picture [m]
  double pixels_per_metre = 1;                       ///< [px/m], above 0
  int rows = 0;                                      ///< [px]
  int cols = 0;                                      ///< [px]
};

/// What is seen in every pixel, row by row.
struct Raster {
  static constexpr std::uint32_t kNothing = 0xffffffffu;

  int rows = 0;
  int cols = 0;
  std::vector<float> height;            ///< towards the viewer, from the view's centre [m]
  std::vector<Eigen::Vector3f> normal;  ///< unit length, in the mesh's frame [1]
  std::vector<std::uint32_t> triangle;  ///< seen here, or kNothing
  std::vector<std::uint8_t> back;       ///< 1 where the triangle shows its back [0 or 1]

  std::size_t covered() const;  ///< pixels that show a triangle [px]
};

struct RasterOptions {
  bool smooth = true;         ///< shade over edges blunter than crease_angle
  double crease_angle = 0.7;  ///< [rad]
  bool hide_backs = false;    ///< leave out triangles that show their back
  int num_threads = 0;        ///< 0 = all cores [1]
};

/// Z-buffer rasterisation: a pixel shows the triangle nearest to the viewer that covers its centre.
/// Triangles with corners that are not finite and those seen edge-on show nothing. The same result
/// for every number of threads.
Raster rasterize(const TriangleMesh& mesh,
                 const RasterView& view,
                 const RasterOptions& options = {});

}  // namespace facula
