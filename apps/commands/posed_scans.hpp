// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/polar_scan.hpp>
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
  std::size_t stripes = 0;        ///< columns with points, 0 where a scan has no grid [1]
};

/// Reads scans, clouds and projects into one project. Scans with a grid lose their mixed points
/// when `filter`. Throws Error as the readers do, and when there is no point at all.
PosedScans read_posed_scans(const std::vector<std::filesystem::path>& paths, bool filter = true);

/// Columns of the scan that hold points.
std::size_t stripes_of(const PolarScan& scan);

/// Throws Error when there is no point, or when all are of one stripe: those lie in the laser
/// plane whatever was scanned, so a mesh or a plane of them would say nothing. `stripes` of 0 is
/// not known and passes.
void require_surface(std::size_t points, std::size_t stripes, const std::filesystem::path& file);

}  // namespace facula
