// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/point_cloud.hpp>

#include <filesystem>

namespace facula {

/// Reads a text of one point per line: x y z after `leading` other numbers (2 for "col row x y z").
/// Blanks, commas and semicolons separate; what follows on a line is ignored, and so are empty
/// lines, lines that start with # or //, and a first line of column names. NaN points are dropped.
/// Throws Error naming file and line.
PointCloud read_point_text(const std::filesystem::path& path, std::size_t leading);

/// Writes "x y z" per point, whole or not at all, so that reading gives the same numbers.
void write_point_text(const std::filesystem::path& path, const PointCloud& cloud);

}  // namespace facula
