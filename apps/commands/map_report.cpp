// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/apps/commands/frontier_figures.hpp>
#include <facula/apps/commands/map_report.hpp>
#include <facula/apps/commands/report_sections.hpp>
#include <facula/apps/report/map_top_view.hpp>
#include <facula/apps/report/png.hpp>
#include <facula/map/find_floor.hpp>
#include <facula/map/frontiers.hpp>
#include <facula/map/height_map.hpp>

namespace facula {
namespace {

constexpr double kRoom = 2.0;  // above the floor that is shown [m]

}  // namespace

ReportSection next_scans_section(const std::string& name,
                                 const OccupancyMap& map,
                                 int num_threads) {
  const Floor floor = find_floor(map);
  FrontierOptions options;
  options.num_threads = num_threads;
  const Frontiers frontiers = find_frontiers(map, floor, options);
  ReportSection section{"Where to scan next in " + name, "", {}, {}};
  section.text =
      "From each numbered place a scan would see more that is unknown than from anywhere near; "
      "what "
      "an earlier place sees does not count for a later one.";
  section.pictures.push_back({"Free, occupied and unknown between the floor and the scanner.",
                              encode_png(frontier_picture(map, floor, frontiers))});
  const HeightMap heights = height_map(map, {.max_height = floor.height + kRoom});
  section.pictures.push_back({"The highest surface of every column below 2 m above the floor.",
                              encode_png(map_top_view(heights))});
  Figures of_floor;
  report_floor(floor, of_floor);
  Figures of_frontiers;
  report_frontiers(frontiers, of_frontiers);
  section.tables = report_tables("Places", of_frontiers);
  section.tables.push_back(figure_table("Frontiers", of_frontiers));
  section.tables.push_back(figure_table("Floor", of_floor));
  return section;
}

}  // namespace facula
