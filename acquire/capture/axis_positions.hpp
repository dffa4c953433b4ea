// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/rig/axis.hpp>

#include <filesystem>
#include <vector>

namespace facula {

/// Reads one axis position per line from a CSV file whose header line has a column position_deg,
/// position_rad (revolute axes) or position_mm (linear); other columns are left alone. Result in
/// rad or m. Throws Error on a missing file or column, a unit that does not fit the axis, or a
/// value that is not a finite number (with its line).
std::vector<double> read_axis_positions(const std::filesystem::path& path, AxisKind axis);

/// Writes such a file with full precision.
void write_axis_positions(const std::filesystem::path& path,
                          const std::vector<double>& positions,
                          AxisKind axis);

}  // namespace facula
