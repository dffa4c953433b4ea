// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/capture/frame_source.hpp>
#include <facula/acquire/core/known_sigma.hpp>
#include <facula/acquire/stripe/stripe_detector.hpp>
#include <facula/apps/cli/arguments.hpp>
#include <facula/apps/cli/figures.hpp>
#include <facula/apps/cli/number_text.hpp>
#include <facula/apps/commands/deviation_figures.hpp>
#include <facula/apps/commands/flatness_figures.hpp>
#include <facula/apps/commands/info_figures.hpp>
#include <facula/apps/commands/map_figures.hpp>
#include <facula/apps/commands/plane_figures.hpp>
#include <facula/apps/commands/report_sections.hpp>
#include <facula/apps/report/deviation_map.hpp>
#include <facula/apps/report/map_top_view.hpp>
#include <facula/apps/report/mesh_views.hpp>
#include <facula/apps/report/plane_deviation.hpp>
#include <facula/apps/report/png.hpp>
#include <facula/apps/report/range_image.hpp>
#include <facula/apps/report/scan_picture.hpp>
#include <facula/apps/report/stripe_over_frame.hpp>

#include <algorithm>
#include <set>

namespace facula {
namespace {

ReportPicture picture(const std::string& caption, const Image8& image) {
  return {caption, encode_png(image)};
}

/// The figures facula info has for a thing, as a table.
template <typename Thing>
ReportTable described(const Thing& thing) {
  Figures figures;
  describe(thing, figures);
  return figure_table("Figures", figures);
}

/// With the noise that the points know; without where they know none.
std::vector<MeasuredFlatness> flatness_of(const PointCloud& cloud,
                                          const std::vector<ExtractedPlane>& planes) {
  std::vector<MeasuredFlatness> result;
  const bool has_noise = knows_sigma(cloud);
  for (const ExtractedPlane& plane : planes) {
    MeasuredFlatness& surface = result.emplace_back();
    surface.flatness = measure_flatness(cloud, plane.indices);
    if (!has_noise) continue;
    surface.uncertainty =
        flatness_uncertainty(cloud, plane.indices, surface.flatness, {.trials = 40});
  }
  return result;
}

std::string plane_caption(std::size_t number,
                          const MeasuredFlatness& surface,
                          const SearchBand& band) {
  const Flatness& flatness = surface.flatness;
  const std::string cut = is_cut(surface, band)
                              ? " The surface or its noise reaches beyond the band of " +
                                    fixed_text(1000 * band.reach, 3) +
                                    " mm in which its points were sought (--plane-inlier-mm)."
                              : "";
  return "Deviations from plane " + std::to_string(number) + ": FLTt " +
         fixed_text(1000 * flatness.total, 3) + " mm, FLTq " +
         fixed_text(1000 * flatness.root_mean_square, 3) + " mm, minimum zone " +
         fixed_text(1000 * flatness.minimum_zone->total, 3) + " mm." + cut;
}

}  // namespace

ReportTable figure_table(const std::string& caption, const Figures& figures) {
  ReportTable table{caption, {"figure", "value"}, {}};
  for (auto& [label, value] : figures.lines()) table.rows.push_back({label, value});
  return table;
}

std::vector<ReportTable> report_tables(const std::string& caption, const Figures& figures) {
  std::vector<ReportTable> tables;
  for (const FigureTable& source : figures.tables()) {
    ReportTable table{source.title.empty() ? caption : source.title, {}, {}};
    for (const auto& column : source.columns) table.columns.push_back(heading(column));
    for (const auto& row : source.rows) {
      std::vector<std::string> cells;
      for (std::size_t c = 0; c < row.size(); ++c) {
        cells.push_back(printed(row[c], source.columns[c].decimals));
      }
      table.rows.push_back(cells);
    }
    tables.push_back(std::move(table));
  }
  return tables;
}

ReportSection capture_section(const Capture& capture) {
  ReportSection section;
  section.heading = "Capture " + capture.file.parent_path().filename().string();
  section.text = "The laser line as it was found, drawn over the frames it was found in.";
  section.tables.push_back(described(capture));
  const CaptureFrames frames(capture);
  if (frames.size() == 0) return section;
  const std::size_t last = frames.size() - 1;
  for (const std::size_t i : std::set<std::size_t>{last / 6, last / 2, last - last / 6}) {
    const Image8 lit = frames.lit(i);
    const StripeProfile profile = detect_stripe(lit.view(), frames.dark(i).view(), capture.stripe);
    section.pictures.push_back(picture(
        "Frame " + std::to_string(i + 1) + ": stripe in " + std::to_string(profile.seen_count()) +
            " of " + std::to_string(profile.size()) + " rows.",
        stripe_over_frame(lit.view(), profile, capture.stripe.direction)));
  }
  return section;
}

ReportSection scan_section(const std::string& name, const PolarScan& scan) {
  ReportSection section{"Scan " + name, "", {}, {}};
  section.pictures.push_back(
      picture("Distance from the sensor, per row and axis position.", range_image(scan)));
  section.tables.push_back(described(scan));
  return section;
}

ReportSection cloud_section(const std::string& heading,
                            const PointCloud& cloud,
                            const std::vector<ExtractedPlane>& planes,
                            const SearchBand& band) {
  ReportSection section{heading, "", {}, {}};
  section.pictures.push_back(
      picture("The points from the front, the side and above.", scan_picture(cloud)));
  section.text = "No plane was found in these points.";
  if (planes.empty()) return section;
  section.text =
      "Planes found in the points; blue points lie below a plane, red ones above. Flatness is that "
      "of surface and noise together: the last columns say what noise alone would show.";
  const std::vector<MeasuredFlatness> flatness = flatness_of(cloud, planes);
  Figures figures;
  report_planes(planes, figures);
  figures.table(flatness_table(flatness));
  section.tables = report_tables("Planes", figures);
  for (std::size_t i = 0; i < planes.size(); ++i) {
    section.pictures.push_back(
        picture(plane_caption(i + 1, flatness[i], band), plane_deviation(planes[i], cloud)));
  }
  return section;
}

ReportSection comparison_section(const std::string& heading,
                                 const PointCloud& cloud,
                                 const Deviations& deviations) {
  ReportSection section{heading, "", {}, {}};
  section.text = deviations.has_sign
                     ? "Red points lie outside the reference or before it, blue ones behind it."
                     : "The reference has no sides, so these are distances.";
  const ColorScale scale = deviation_scale(deviations.values, deviations.has_sign);
  section.pictures.push_back(picture("Deviations of the points from the reference.",
                                     deviation_map(cloud, deviations.values, scale)));
  Figures figures;
  report_deviations(deviations, figures);
  section.tables.push_back(figure_table("Deviations", figures));
  return section;
}

ReportSection project_section(const ScanProject& project) {
  ReportSection section{"Poses", "Where the scans were taken from, in the world frame.", {}, {}};
  ReportTable table{
      "Scans", {"scan", "points", "x [mm]", "y [mm]", "z [mm]", "turned by [deg]"}, {}};
  for (const PosedCloud& scan : project.scans) {
    const Eigen::Vector3d x = 1000 * scan.world_from_scan.translation;
    table.rows.push_back({scan.name,
                          std::to_string(scan.cloud.size()),
                          fixed_text(x.x(), 1),
                          fixed_text(x.y(), 1),
                          fixed_text(x.z(), 1),
                          fixed_text(rotation_angle(scan.world_from_scan) / kDegrees.factor, 3)});
  }
  section.tables.push_back(table);
  return section;
}

ReportSection mesh_section(const std::string& name, const TriangleMesh& mesh, int num_threads) {
  ReportSection section{"Mesh " + name, "", {}, {}};
  MeshViewsOptions options;
  options.num_threads = num_threads;
  section.pictures.push_back(picture("The mesh from the front, the side and obliquely from above.",
                                     mesh_views(mesh, options)));
  section.tables.push_back(described(mesh));
  return section;
}

ReportSection map_section(const std::string& name,
                          const OccupancyMap& map,
                          const std::vector<RigidTransform>& world_from_scan) {
  ReportSection section{"Map " + name, "", {}, {}};
  Figures figures;
  report_map(map, figures);
  section.pictures.push_back(picture("The highest occupied cell of every column, from above.",
                                     map_top_view(map, world_from_scan)));
  section.tables.push_back(figure_table("Figures", figures));
  return section;
}

ReportSection grid_section(const std::string& name,
                           const NavigationGrid& grid,
                           const std::vector<RigidTransform>& world_from_scan) {
  ReportSection section{"Navigation grid " + name, "", {}, {}};
  Figures figures;
  report_grid(grid, figures);
  section.pictures.push_back(picture("Free cells light, occupied ones dark, unknown ones grey.",
                                     map_top_view(grid, world_from_scan)));
  section.tables.push_back(figure_table("Figures", figures));
  return section;
}

}  // namespace facula
