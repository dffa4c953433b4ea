// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/csv_table.hpp>
#include <facula/apps/commands/path_table.hpp>
#include <facula/apps/commands/report_sections.hpp>
#include <facula/apps/report/path_picture.hpp>
#include <facula/apps/report/png.hpp>

#include <algorithm>

namespace facula {

FigureTable path_table(const PathPlan& plan) {
  FigureTable table{
      "path",
      "Path:",
      {{"x_m", "x", 3}, {"y_m", "y", 3}, {"z_m", "z", 3}, {"clearance_m", "clearance", 3}},
      {}};
  for (const PathSample& sample : plan.samples) {
    table.rows.push_back({sample.x.x(), sample.x.y(), sample.x.z(), sample.clearance});
  }
  return table;
}

PathPlan read_path_table(const std::filesystem::path& path) {
  const CsvTable csv = CsvTable::from_file(path);
  const std::vector<double> x = csv.column({"x_m"});
  const std::vector<double> y = csv.column({"y_m"});
  const std::vector<double> z = csv.column({"z_m"});
  const std::vector<double> clearance = csv.column({"clearance_m"});
  PathPlan plan;
  for (std::size_t i = 0; i < x.size(); ++i) {
    plan.samples.push_back({{x[i], y[i], z[i]}, clearance[i]});
    if (i > 0) plan.length += (plan.samples[i].x - plan.samples[i - 1].x).norm();
  }
  plan.least_clearance = *std::min_element(clearance.begin(), clearance.end());
  return plan;
}

void report_path(const PathPlan& plan, Figures& figures) {
  const double straight = (plan.samples.back().x - plan.samples.front().x).norm();
  figures.number("length_m", "length", plan.length, 3);
  figures.number("straight_m", "straight line", straight, 3);
  figures.number("least_clearance_m", "least clearance", plan.least_clearance, 3);
  figures.count("samples", "samples", plan.samples.size());
}

ReportSection path_section(const std::string& name, const OccupancyMap& map, const PathPlan& plan) {
  ReportSection section{"Path " + name, "", {}, {}};
  Figures figures;
  report_path(plan, figures);
  const Image8 picture = path_picture(map, plan, plan.least_clearance);
  section.pictures.push_back(
      {"The path in the colours of its clearance, over the map at the path's heights.",
       encode_png(picture)});
  section.tables.push_back(figure_table("Figures", figures));
  return section;
}

}  // namespace facula
