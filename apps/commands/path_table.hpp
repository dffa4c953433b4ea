// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/apps/cli/figures.hpp>
#include <facula/apps/report/html_report.hpp>
#include <facula/map/occupancy_map.hpp>
#include <facula/map/path_plan.hpp>

#include <filesystem>
#include <string>

namespace facula {

/// The samples of a path as a table: x_m, y_m, z_m, clearance_m.
FigureTable path_table(const PathPlan& plan);

/// Reads such a table (.csv); the result has samples, length and least clearance. Throws Error when
/// the file is missing or is none.
PathPlan read_path_table(const std::filesystem::path& path);

void report_path(const PathPlan& plan, Figures& figures);

/// A path over its map from above.
ReportSection path_section(const std::string& name, const OccupancyMap& map, const PathPlan& plan);

}  // namespace facula
