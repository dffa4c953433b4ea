// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/ply_table.hpp>
#include <facula/acquire/core/point_cloud.hpp>
#include <facula/acquire/core/scan_grid.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace facula {

/// The grid of a Cyberware range image (Stanford 3D Scanning Repository): element `range_grid`, a
/// list of no or one vertex index per cell, row by row, of `obj_info num_cols` columns and
/// `obj_info num_rows` rows. Indices are of the finite vertices in file order, as read_cloud keeps
/// them. An empty grid when the file has no such element; throws Error when the element does not
/// fit the header or the vertices.
ScanGrid range_grid(const std::vector<PlyElement>& elements,
                    const std::vector<std::string>& infos,
                    const std::filesystem::path& path);

/// Where each point of such a range image was seen from: 1 m from it, towards the scanner. A stage
/// moves the sheet of light along x, so x follows from the column; within the sheet the rows are
/// lines of sight that meet at one point, y = y0 + r (b + m z) + c z, found by least squares. The
/// side on which they meet is the scanner's. Where the lines look parallel the scanner stands at
/// +z, as in every scan of the repository. Nothing when x does not follow from the column.
std::vector<Eigen::Vector3f> seen_from(const PointCloud& cloud, const ScanGrid& grid);

}  // namespace facula
