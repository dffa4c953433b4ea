// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/polar_scan.hpp>

#include <filesystem>

namespace facula {

/// Reads a scan that write_scan() wrote as .pcd. Throws Error when the file is missing, torn, not
/// organised, or lacks one of the fields x y z.
PolarScan read_scan(const std::filesystem::path& path);

/// Writes a scan; the extension chooses the format. Files appear whole or not at all.
///   .pcd  organised, width = columns, height = rows, fields x y z intensity range yaw pitch sigma,
///         little-endian binary, VIEWPOINT = world_from_scan. Header comments (which other readers
///         skip) carry axis position, time and sensor origin of every column, and how the scan
///         stands, so that reading gives back the same scan bit for bit.
///   .ply  the valid points with row, col, intensity and sigma.
///   .asc  a line "col row x y z" per valid point, in metres (source C).
void write_scan(const std::filesystem::path& path, const PolarScan& scan);

}  // namespace facula
