// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/point_cloud.hpp>
#include <facula/acquire/core/scan_grid.hpp>

#include <filesystem>

namespace facula {

/// Reads a point cloud in metres by its extension: .ply (ascii or binary, either byte order; other
/// elements such as faces or range_grid are skipped), .pcd (ascii, binary; a scan's valid cells),
/// .xyz .txt .csv .dat (x y z per line), .asc (col row x y z per line). NaN points are dropped.
/// Throws Error when the file is missing, has no points, or holds fewer or more values than its
/// header says. `grid`, when given, receives the grid the points were scanned in, or is left empty
/// where the file has none; points of a grid get sensor origins where the grid tells the line of
/// sight (range_grid.hpp).
PointCloud read_cloud(const std::filesystem::path& path, ScanGrid* grid = nullptr);

/// Writes a cloud as .ply (binary), .pcd (binary) or .xyz (text), whole or not at all.
void write_cloud(const std::filesystem::path& path, const PointCloud& cloud);

}  // namespace facula
