// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/capture/capture.hpp>
#include <facula/acquire/core/polar_scan.hpp>
#include <facula/acquire/core/triangle_mesh.hpp>
#include <facula/apps/cli/figures.hpp>
#include <facula/apps/commands/flatness_figures.hpp>
#include <facula/apps/report/html_report.hpp>
#include <facula/map/navigation_grid.hpp>
#include <facula/map/occupancy_map.hpp>
#include <facula/reconstruct/measure/deviation.hpp>
#include <facula/reconstruct/measure/plane.hpp>
#include <facula/reconstruct/register/scan_project.hpp>

#include <string>
#include <vector>

namespace facula {

// The parts of a report, each made of one result: a few sentences, pictures, tables.

/// The found stripe over three frames: near the start, in the middle, near the end.
ReportSection capture_section(const Capture& capture);

/// Range image.
ReportSection scan_section(const std::string& name, const PolarScan& scan);

/// The cloud from three sides, its planes with the figures of measure planes and measure flatness,
/// and a picture of each plane's deviations.
/// `band` is what they were sought in, infinite where it is not known: planes
/// that it cut are named.
ReportSection cloud_section(const std::string& heading,
                            const PointCloud& cloud,
                            const std::vector<ExtractedPlane>& planes,
                            const SearchBand& band = {});

/// Colour map, histogram and figures of points compared with a reference.
ReportSection comparison_section(const std::string& heading,
                                 const PointCloud& cloud,
                                 const Deviations& deviations);

/// Poses of a project.
ReportSection project_section(const ScanProject& project);

/// The mesh from three sides.
ReportSection mesh_section(const std::string& name, const TriangleMesh& mesh, int num_threads);

/// A map or grid from above, with the places the scans were taken from.
ReportSection map_section(const std::string& name,
                          const OccupancyMap& map,
                          const std::vector<RigidTransform>& world_from_scan);
ReportSection grid_section(const std::string& name,
                           const NavigationGrid& grid,
                           const std::vector<RigidTransform>& world_from_scan);

/// A line per figure: name, value, unit.
ReportTable figure_table(const std::string& caption, const Figures& figures);

/// The tables among the figures.
std::vector<ReportTable> report_tables(const std::string& caption, const Figures& figures);

}  // namespace facula
