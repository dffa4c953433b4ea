// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/triangle_mesh.hpp>
#include <facula/reconstruct/mesh/distance_volume.hpp>

#include <cstdint>
#include <optional>
#include <vector>

namespace facula {

struct SurfaceExtractionOptions {
  float max_jump = 2;                  ///< distances of neighbouring voxels differ by no more where
                                       ///< one surface runs between them [voxels]
  std::optional<BrickBox> cells_from;  ///< only the cells whose first voxel lies in these bricks
  int num_threads = 0;                 ///< 0 = all cores [1]
};

/// A voxel edge that the surface crosses.
struct CrossedEdge {
  BrickPlace brick;
  std::uint16_t edge = 0;  ///< 3 * voxel_index + axis
};

struct ExtractedSurface {
  TriangleMesh mesh;               ///< world frame, looking towards positive distances
  std::vector<CrossedEdge> edges;  ///< of every vertex
};

/// The surface of distance zero by marching cubes, in cells of which all eight voxels have been
/// seen. Vertices are shared; the same for every number of threads.
ExtractedSurface extract_surface(const DistanceVolume& volume,
                                 const SurfaceExtractionOptions& options = {});

}  // namespace facula
