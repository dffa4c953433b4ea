// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/apps/cli/output_path.hpp>
#include <facula/apps/cli/usage_error.hpp>
#include <facula/apps/commands/frontier_figures.hpp>
#include <facula/apps/commands/map_figures.hpp>
#include <facula/apps/commands/map_outputs.hpp>
#include <facula/apps/report/map_top_view.hpp>
#include <facula/apps/report/png.hpp>
#include <facula/map/find_floor.hpp>
#include <facula/map/height_map.hpp>

#include <algorithm>
#include <cmath>

namespace facula {
namespace {

/// Every file that will be written, those beside the named ones too.
std::vector<std::filesystem::path> files_of(const MapOutputs& o) {
  std::vector<std::filesystem::path> files;
  if (!o.grid.empty()) {
    files.push_back(o.grid);
    const bool scale = grid_mode(o.grid_mode) == GridMode::kScale;
    files.push_back(std::filesystem::path(o.grid).replace_extension(scale ? ".png" : ".pgm"));
  }
  for (const auto& path : o.height_maps) {
    files.push_back(path);
    if (path.extension() != ".png") files.push_back(std::filesystem::path(path) += ".yaml");
  }
  files.insert(files.end(), o.frontiers.begin(), o.frontiers.end());
  std::sort(files.begin(), files.end());
  return files;
}

Floor given_or_found_floor(const OccupancyMap& map, const MapOutputs& o) {
  if (!o.floor) return find_floor(map);
  const double cell = map.resolution();
  return {.height = *o.floor, .top = (std::floor(*o.floor / cell + 1e-6) + 1) * cell};
}

/// The heights that block the robot, in the world. What the floor's own cells fill blocks nobody.
NavigationGridOptions band_of(const MapOutputs& o, const std::optional<Floor>& floor) {
  NavigationGridOptions band = o.band;
  if (!o.above_floor) return band;
  band.min_height = std::max(floor->height + o.band.min_height, floor->top);
  band.max_height = floor->height + o.band.max_height;
  return band;
}

void write_grid(const OccupancyMap& map,
                const MapOutputs& o,
                const NavigationGridOptions& band,
                Figures& figures) {
  const NavigationGrid grid = navigation_grid(map, band);
  write_navigation_grid(o.grid, grid, {.mode = grid_mode(o.grid_mode), .ros1 = o.ros1});
  figures.text("mode", "mode", o.grid_mode);
  figures.numbers("heights_m", "heights that block", {band.min_height, band.max_height}, 3);
  report_grid(grid, figures);
}

void write_height_maps(const OccupancyMap& map,
                       const MapOutputs& o,
                       double max_height,
                       Figures& figures) {
  const HeightMap heights = height_map(map, {.max_height = max_height});
  for (const auto& path : o.height_maps) {
    if (path.extension() == ".png")
      write_png(path, map_top_view(heights));
    else
      write_height_map(path, heights);
  }
  report_height_map(heights, max_height, figures);
}

void write_next_scans(const OccupancyMap& map,
                      const MapOutputs& o,
                      const Floor& floor,
                      Session& session) {
  FrontierOptions options = o.next_scans;
  options.num_threads = session.num_threads;
  const Frontiers found = find_frontiers(map, floor, options);
  for (const auto& path : o.frontiers) {
    if (path.extension() == ".png")
      write_png(path, frontier_picture(map, floor, found));
    else
      write_frontiers_csv(path, found);
  }
  report_frontiers(found, session.figures.part("frontiers", "Where to scan next:"));
}

}  // namespace

void declare_map_outputs(Arguments& arguments, MapOutputs& o) {
  arguments.output("--grid", o.grid, "also write a navigation grid (.yaml, its picture beside it)");
  arguments.choice("--grid-mode",
                   o.grid_mode,
                   {"trinary", "scale", "raw"},
                   "three states (.pgm), or probabilities: scale (.png with alpha), raw (.pgm)");
  arguments.flag("--ros1", o.ros1, "thresholds of ROS 1 in mode scale, else those of nav2");
  arguments.flag("--above-floor", o.above_floor, "heights count from the floor, which is found");
  arguments.number(
      "--floor-m", o.floor, kMetres, "height of the floor, where it is not to be found");
  arguments.number(
      "--min-height-m", o.band.min_height, kMetres, "lowest part of space that blocks the robot");
  arguments.number("--max-height-m",
                   o.band.max_height,
                   kMetres,
                   "highest such part; what is above is left out of height maps too");
  arguments.number("--inflate-m",
                   o.band.inflation,
                   kMetres,
                   "radius of the robot: cells this near an occupied one are occupied too");
  arguments.outputs("--height-map",
                    o.height_maps,
                    "also write the highest surface per column: .tif (32-bit float, with a "
                    ".tif.yaml beside it) or .png (a picture)");
  arguments.outputs("--frontiers",
                    o.frontiers,
                    "also write where to scan next: .csv (a list) or .png (a picture)");
  arguments.number("--scanner-height-m",
                   o.next_scans.stand.scanner_height,
                   kMetres,
                   "of the scanner above the floor, for --frontiers");
  arguments.number("--scanner-range-m", o.next_scans.range, kMetres, "how far the scanner sees");
  arguments.whole("--next-scans", o.next_scans.count, "how many places --frontiers names at most");
}

void check_map_outputs(const MapOutputs& o) {
  if (!o.grid.empty()) check_output(o.grid, {".yaml", ".yml"});
  for (const auto& path : o.height_maps) check_output(path, {".tif", ".tiff", ".png"});
  for (const auto& path : o.frontiers) check_output(path, {".csv", ".png"});
  const auto files = files_of(o);
  const auto twice = std::adjacent_find(files.begin(), files.end());
  if (twice != files.end()) {
    fail_usage("two outputs would be written to '", twice->string(), "'; give them other names");
  }
  if (o.floor && !o.above_floor && o.frontiers.empty()) {
    fail_usage("--floor-m belongs to --above-floor or --frontiers");
  }
  o.band.check();
  o.next_scans.check();
}

void write_map_outputs(const OccupancyMap& map, const MapOutputs& o, Session& session) {
  std::optional<Floor> floor;
  if (o.above_floor || !o.frontiers.empty()) {
    floor = given_or_found_floor(map, o);
    report_floor(*floor, session.figures.part("floor", "Floor:"));
  }
  const NavigationGridOptions band = band_of(o, floor);
  if (!o.grid.empty()) {
    write_grid(map, o, band, session.figures.part("grid", "Navigation grid:"));
  }
  if (!o.height_maps.empty()) {
    write_height_maps(map, o, band.max_height, session.figures.part("height_map", "Height map:"));
  }
  if (!o.frontiers.empty()) write_next_scans(map, o, *floor, session);
}

}  // namespace facula
