// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/triangle_mesh.hpp>
#include <facula/reconstruct/mesh/volumetric_merge.hpp>
#include <facula/reconstruct/register/scan_project.hpp>

#include <cstddef>
#include <functional>
#include <vector>

namespace facula {

/// Scans that are read when they are needed, and forgotten again.
struct ScanSource {
  std::size_t count = 0;
  /// The same scan for the same number [0, count) every time, with its pose.
  std::function<PosedCloud(std::size_t)> load;
};

/// Takes a mesh piece by piece: vertices are numbered in the order they come, and triangles name
/// any vertex that has come.
using MeshPieceSink = std::function<void(const std::vector<Eigen::Vector3f>& vertices,
                                         const std::vector<TriangleMesh::Triangle>& triangles)>;

struct BlockMergeResult {
  double voxel = 0;               ///< used [m]
  double truncation = 0;          ///< used [m]
  std::size_t blocks = 0;         ///< [1]
  std::size_t bricks = 0;         ///< of 8 x 8 x 8 voxels, over all blocks [1]
  std::size_t largest_block = 0;  ///< bricks held at once [1]
  std::size_t loads = 0;          ///< how often a scan was read [1]
  std::size_t vertices = 0;       ///< [1]
  std::size_t triangles = 0;      ///< [1]
};

/// merge_volumetric() for scenes larger than the memory: the same vertices, bit for bit, and the
/// same triangles between them, block after block. Blocks share the vertices on their borders.
/// Needs at a time about options.max_memory for one block (its voxels take up to a quarter, the
/// lists of triangles and the block's mesh the rest), 300 bytes per point for one scan, 40 bytes
/// for every brick of the scene and 16 bytes for every vertex on a block's border. Every scan is
/// read once to see where it runs (twice where the voxel is to be taken from the sampling), and
/// once for every block it reaches into. Throws Error as merge_volumetric() does.
BlockMergeResult merge_volumetric_in_blocks(const ScanSource& source,
                                            const MeshPieceSink& sink,
                                            const VolumetricOptions& options = {});

}  // namespace facula
