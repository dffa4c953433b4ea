// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/reconstruct/register/scan_project.hpp>

#include <cstddef>
#include <filesystem>
#include <vector>

namespace facula {

/// Scans as the commands behind the acquisition take them in.
struct PosedScans {
  ScanProject project;
  std::size_t points_read = 0;    ///< over all scans [1]
  std::size_t mixed_removed = 0;  ///< points between two surfaces [1]
};

/// Reads scans, clouds and projects into one project. Scans with a grid lose their mixed points
/// when `filter`. Throws Error as the readers do, and when there is no point at all.
PosedScans read_posed_scans(const std::vector<std::filesystem::path>& paths, bool filter = true);

}  // namespace facula
