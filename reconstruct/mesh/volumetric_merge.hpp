// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/progress.hpp>
#include <facula/acquire/core/triangle_mesh.hpp>
#include <facula/reconstruct/register/scan_project.hpp>

#include <cstddef>

namespace facula {

/// How scans become one surface after Curless and Levoy, "A volumetric method for building complex
/// models from range images" (SIGGRAPH 1996).
struct VolumetricOptions {
  double voxel = 0;            ///< edge of a voxel [m]; 0 = from the scans' sampling
  double truncation = 0;       ///< half width of the band around each scan's surface that its lines
                               ///< of sight update, along the normal [m]; 0 = 3 voxels
  double max_incidence = 1.4;  ///< a steeper piece of a scan is a depth jump [rad], below pi/2
  double border_cells = 6;     ///< weights fade over so many cells towards a scan's border [1]
  double max_memory = 3e9;     ///< voxels and lists may take so much [byte]
  int num_threads = 0;         ///< 0 = all cores [1]
  Progress progress = {};      ///< by scans, or by blocks where it is merged in blocks

  void check() const;
};

/// The merged surface and how it came about.
struct VolumetricResult {
  TriangleMesh mesh;                ///< world frame; counter-clockwise seen from the scanners
  double voxel = 0;                 ///< used [m]
  double truncation = 0;            ///< used [m]
  std::size_t bricks = 0;           ///< of 8 x 8 x 8 voxels near the surface [1]
  std::size_t range_triangles = 0;  ///< of the scans' own surfaces [1]
  std::size_t skipped_points = 0;   ///< not finite, or with neither normal nor neighbours [1]
};

/// One surface from posed scans. Each scan's range surface (triangles of neighbouring cells of its
/// grid without depth jumps; small discs about its points where it has no grid) adds a signed
/// distance to the voxels along its lines of sight, in front of it and behind it within the
/// truncation, with a weight from sigma, incidence and the distance to the scan's border. The zero
/// surface of the weighted mean is extracted where all corners of a cell have been seen, so that
/// what no scan saw stays open. The mesh is manifold but for single vertices at its borders, and
/// the same bit for bit for every number of threads. Lines of sight come from sensor_origin, else
/// from the normals (estimated towards the scan frame's origin where missing).
/// Throws Error when no scan has a surface, VolumeMemoryError when the voxels asked for need more
/// than max_memory (see merge_volumetric_in_blocks()).
VolumetricResult merge_volumetric(const ScanProject& project,
                                  const VolumetricOptions& options = {});

}  // namespace facula
