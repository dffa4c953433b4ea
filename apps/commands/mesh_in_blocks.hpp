// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/apps/cli/figures.hpp>
#include <facula/reconstruct/mesh/volumetric_merge.hpp>
#include <facula/reconstruct/register/scan_project.hpp>

#include <filesystem>

namespace facula {

/// Merges scans whose mesh the memory does not hold block by block, and writes it to a .ply as it
/// comes: no step, no verdict. Throws Error as merge_volumetric_in_blocks() and StreamedPly do, and
/// where there is no surface.
void mesh_in_blocks(const ScanProject& project,
                    const VolumetricOptions& options,
                    const std::filesystem::path& out,
                    Figures& figures);

}  // namespace facula
