// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/point_cloud.hpp>
#include <facula/acquire/core/polar_scan.hpp>
#include <facula/acquire/core/triangle_mesh.hpp>

namespace facula {

struct AdvancingFrontOptions {
  double max_edge = 0;            ///< longest edge [m]; 0 = 6 times the median point spacing or
                                  ///< 3 times the step from stripe to stripe, whichever is longer
  double radius_ratio_bound = 5;  ///< CGAL's plausibility bound [1]
  double beta = 0.52;             ///< CGAL's angle bound [rad]

  void check() const;
};

/// A surface through the points by advancing front (Cohen-Steiner and Da 2004, CGAL). Triangles are
/// turned towards the points' sensor origins where the cloud has them.
TriangleMesh mesh_advancing_front(const PointCloud& cloud,
                                  const AdvancingFrontOptions& options = {});

struct GridMeshOptions {
  double max_edge = 0.05;    ///< longest edge [m]
  double edge_ratio = 0.05;  ///< or this share of the distance to the sensor, if larger [1]
  bool close_turn = false;   ///< join the last column to the first (a full turn)

  void check() const;
};

/// Two triangles for every four neighbouring cells (one where a cell is not valid), none with an
/// edge longer than the options allow, so none across depth edges; turned towards the sensor.
TriangleMesh mesh_grid(const PolarScan& scan, const GridMeshOptions& options = {});

/// Distance from every point to the nearest point of the mesh's surface [m]; NaN for points that
/// are not finite. Throws Error when the mesh has no surface.
std::vector<double> distances_to_mesh(const std::vector<Eigen::Vector3f>& points,
                                      const TriangleMesh& mesh,
                                      int num_threads = 0);

}  // namespace facula
