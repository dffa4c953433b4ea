// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/apps/commands/mesh_in_blocks.hpp>
#include <facula/reconstruct/mesh/streamed_ply.hpp>
#include <facula/reconstruct/mesh/volumetric_blocks.hpp>

namespace facula {

void mesh_in_blocks(const ScanProject& project,
                    const VolumetricOptions& options,
                    const std::filesystem::path& out,
                    Figures& figures) {
  StreamedPly file(out);
  const BlockMergeResult merged = merge_volumetric_in_blocks(
      {project.scans.size(), [&project](std::size_t scan) { return project.scans[scan]; }},
      [&file](const auto& vertices, const auto& triangles) { file.add(vertices, triangles); },
      options);
  require(merged.triangles > 0, "expected a surface through the points, got no triangle");
  file.commit();
  figures.number("voxel_mm", "voxel", 1000 * merged.voxel, 3);
  figures.count("blocks", "merged in blocks", merged.blocks);
  figures.count("vertices", "vertices", merged.vertices);
  figures.count("triangles", "triangles", merged.triangles);
  figures.text("verdict", "verdict", "neither cleaned nor judged: larger than the memory");
}

}  // namespace facula
