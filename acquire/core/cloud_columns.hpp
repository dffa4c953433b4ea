// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/number_column.hpp>
#include <facula/acquire/core/point_cloud.hpp>

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace facula {

/// The column of a name, or null. The names are those of PLY and PCD files: x y z, nx ny nz or
/// normal_x normal_y normal_z, red green blue or the packed rgb or rgba, intensity, sigma,
/// sensor_x sensor_y sensor_z.
using ColumnLookup = std::function<const NumberColumn*(const std::string& name)>;

/// The points of a table whose x y and z are numbers, with every attribute that is there whole.
/// Intensities stored as integers are scaled to [0..1]. Throws Error naming the file when x, y or z
/// is missing.
PointCloud cloud_from_columns(const ColumnLookup& find, const std::filesystem::path& path);

/// A cloud's columns under the names that PLY readers know.
std::vector<NumberColumn> ply_columns(const PointCloud& cloud);

/// A cloud's columns under the names that PCD readers know.
std::vector<NumberColumn> pcd_columns(const PointCloud& cloud);

}  // namespace facula
