// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/polar_scan.hpp>
#include <facula/reconstruct/register/scan_list.hpp>

#include <cstddef>
#include <filesystem>
#include <optional>
#include <vector>

namespace facula {

/// Scans as the commands behind the acquisition take them in.
struct PosedScans {
  ScanProject project;
  std::size_t points_read = 0;    ///< over all scans [1]
  std::size_t mixed_removed = 0;  ///< points between two surfaces [1]
  std::size_t stripes = 0;        ///< columns with points, 0 where a scan has no grid [1]
};

/// The scans of files and projects in the order given, none of them opened. Throws Error where a
/// path is missing or holds no scans.
std::vector<ListedScan> list_posed_scans(const std::vector<std::filesystem::path>& paths);

/// One scan as the commands behind the acquisition take it in.
struct CleanScan {
  PosedCloud posed;
  std::size_t points_read = 0;         ///< [1]
  std::size_t mixed_removed = 0;       ///< points between two surfaces [1]
  std::optional<std::size_t> stripes;  ///< columns with points; none where it has no grid [1]
};

/// Opens a scan. One with a grid loses its mixed points when `filter`.
CleanScan read_clean_scan(const ListedScan& listed, bool filter = true);

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
