// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/apps/report/html_report.hpp>
#include <facula/map/occupancy_map.hpp>

#include <string>

namespace facula {

/// A map for who wants to drive or scan on: its floor, what is below 2 m above it, and where to
/// scan next. Throws Error where there is no floor.
ReportSection next_scans_section(const std::string& name, const OccupancyMap& map, int num_threads);

}  // namespace facula
