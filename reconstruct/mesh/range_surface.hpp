// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/triangle_mesh.hpp>
#include <facula/reconstruct/register/scan_project.hpp>

#include <cstddef>
#include <vector>

namespace facula {

/// A corner of a scan's own surface, with the line of sight it was measured along.
struct SightVertex {
  Eigen::Vector3f point;   ///< in the world frame [m]
  Eigen::Vector3f toward;  ///< unit vector from the point to the scanner [1]
  float cosine = 1;        ///< of the angle between line of sight and surface normal [0..1]
  float weight = 1;        ///< trust in the point, 1 for a sigma of 1 mm seen straight on [1]
};

/// What one scan says the surface is.
struct RangeSurface {
  std::vector<SightVertex> vertices;
  std::vector<TriangleMesh::Triangle> triangles;
  double step = 0;                 ///< median distance of neighbouring samples [m]
  std::size_t skipped_points = 0;  ///< not finite, or without a neighbour or normal [1]
};

struct RangeSurfaceOptions {
  double max_incidence = 1.4;  ///< a steeper piece is a depth jump [rad], below pi/2
  double border_cells = 6;     ///< weights fade over so many cells towards the border [1]
  int num_threads = 0;         ///< 0 = all cores [1]
};

/// Triangles of neighbouring cells of the scan's grid without depth jumps; the last column joins
/// the first where a turn has come full circle. Small discs about the points where the scan has no
/// grid. Depends on this scan alone.
RangeSurface range_surface(const PosedCloud& scan, const RangeSurfaceOptions& options);

/// The two kinds of it. `toward` holds the line of sight of every point, `distance` how far away
/// the scanner stood (any constant for parallel lines).
struct SightLines {
  std::vector<Eigen::Vector3f> toward;  ///< zero where the point cannot be used [1]
  std::vector<float> distance;          ///< [m]
};
RangeSurface surface_of_grid(const PosedCloud& scan,
                             const SightLines& sight,
                             const RangeSurfaceOptions& options);
RangeSurface surface_of_points(const PosedCloud& scan, const SightLines& sight);

/// Trust in a point from its sigma alone, 1 at 1 mm and where the cloud has none.
float sigma_weight(const PointCloud& cloud, std::size_t point);

}  // namespace facula
