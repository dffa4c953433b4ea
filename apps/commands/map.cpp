// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/apps/cli/output_path.hpp>
#include <facula/apps/cli/usage_error.hpp>
#include <facula/apps/commands/map.hpp>
#include <facula/apps/commands/map_figures.hpp>
#include <facula/apps/commands/place_scans.hpp>
#include <facula/apps/commands/posed_scans.hpp>
#include <facula/map/navigation_grid.hpp>
#include <facula/map/occupancy_map.hpp>
#include <facula/map/octomap_judge.hpp>

#include <memory>
#include <optional>
#include <string>

namespace facula {
namespace {

struct MapArguments {
  std::vector<std::filesystem::path> scans;
  std::vector<std::filesystem::path> out;
  std::filesystem::path grid;
  std::string place = "auto";
  bool verify = false;
  OccupancyOptions options;
  NavigationGridOptions grid_options;
};

void declare(Arguments& arguments, MapArguments& a) {
  arguments.inputs("SCANS", a.scans, "a scan, several, or a project (poses.toml, .conf, folder)");
  arguments.required();
  arguments.outputs("--out", a.out, "the map: .bt (free or occupied) or .ot (probabilities)");
  arguments.required();
  arguments.number("--resolution-mm", a.options.resolution, kMillimetres, "edge of a cell");
  arguments.number("--max-range-m",
                   a.options.max_range,
                   kMetres,
                   "longer rays only clear space up to here, 0 = no limit");
  arguments.number("--hit", a.options.hit, kPlainNumber, "probability of a cell a ray ends in");
  arguments.number("--miss", a.options.miss, kPlainNumber, "of a cell that a ray passes");
  arguments.number("--clamp-min", a.options.clamp_min, kPlainNumber, "least a cell can reach");
  arguments.number("--clamp-max", a.options.clamp_max, kPlainNumber, "most a cell can reach");
  arguments.flag("--discretize",
                 a.options.discretize,
                 "one ray per cell that points lie in, to its middle: faster, coarser");
  arguments.flag("--weigh-sigma",
                 a.options.weigh_sigma,
                 "points whose sigma is large against a cell hit it less; not as OctoMap does");
  arguments.choice("--register",
                   a.place,
                   {"auto", "always", "never"},
                   "find the poses of the scans; auto: of scans that have none");
  arguments.flag(
      "--verify", a.verify, "build the map once more with liboctomap and compare every byte");
  arguments.output("--grid", a.grid, "also write a navigation grid (.yaml, with a .pgm beside it)");
  arguments.number("--min-height-m",
                   a.grid_options.min_height,
                   kMetres,
                   "lowest part of space that blocks the robot");
  arguments.number("--max-height-m", a.grid_options.max_height, kMetres, "highest such part");
}

PosedScans read_scans(const MapArguments& a, Session& session) {
  PosedScans scans = read_posed_scans(a.scans);
  session.figures.count("scans", "scans", scans.project.scans.size());
  session.figures.count("points", "points", scans.points_read);
  session.figures.count("mixed_removed", "mixed points removed", scans.mixed_removed);
  place_scans(scans, a.place, session);
  return scans;
}

/// Says whether liboctomap made the same map; throws Error where it did not.
void report_verdict(const OctomapJudge& judge, const OccupancyMap& map, Figures& figures) {
  const OctomapVerdict verdict = judge.verdict(map);
  require(verdict.same_ot && verdict.same_bt,
          "the map differs from liboctomap's of the same scans (",
          verdict.nodes,
          " nodes there); this is a defect of Facula: please report it with the scans");
  figures.flag("same_as_octomap", "same as liboctomap", true);
  figures.number("octomap_seconds", "liboctomap took, s", verdict.seconds, 3);
  figures.count("octomap_memory", "memory of its tree, bytes", verdict.memory);
}

OccupancyMap build_map(const MapArguments& a, Session& session) {
  const PosedScans scans = read_scans(a, session);
  OccupancyOptions options = a.options;
  options.num_threads = session.num_threads;
  OccupancyMap map(options);
  std::optional<OctomapJudge> judge;
  if (a.verify) judge.emplace(options);
  const Progress progress = session.progress("casting rays");
  std::size_t done = 0;
  for (const PosedCloud& scan : scans.project.scans) {
    const PointCloud cloud = transformed(scan.cloud, scan.world_from_scan);
    map.insert(cloud);
    if (judge) judge->insert(cloud);
    progress(++done, scans.project.scans.size());
  }
  require(map.skipped_points() < scans.points_read - scans.mixed_removed,
          "expected points within 32768 cells of the origin, got none at a cell of ",
          1000 * options.resolution,
          " mm; choose a larger --resolution-mm, or look at the scan with 'facula info'");
  if (judge) report_verdict(*judge, map, session.figures);
  return map;
}

void run(const MapArguments& a, Session& session) {
  for (const auto& path : a.out) check_output(path, {".bt", ".ot"});
  if (a.verify && a.options.weigh_sigma) {
    fail_usage("--verify and --weigh-sigma exclude each other: OctoMap does not weigh hits");
  }
  if (!a.grid.empty()) check_output(a.grid, {".yaml"});
  a.options.check();
  a.grid_options.check();
  const OccupancyMap map = build_map(a, session);
  std::optional<NavigationGrid> grid;
  if (!a.grid.empty()) grid = navigation_grid(map, a.grid_options);
  for (const auto& path : a.out) map.write(path);
  session.figures.count("skipped_points", "points skipped", map.skipped_points());
  report_map(map, session.figures);
  if (!grid) return;
  write_navigation_grid(a.grid, *grid);
  report_grid(*grid, session.figures.part("grid", "Navigation grid:"));
}

}  // namespace

Command map_command() {
  const auto a = std::make_shared<MapArguments>();
  return {
      .name = "map",
      .summary = "make an occupancy map and a navigation grid",
      .description =
          "Casts a ray from the scanner to every point and marks the cells of space as free, "
          "occupied or unknown (OctoMap). The grid is the map seen from above, as ROS map "
          "servers read it.",
      .examples =
          {"facula simulate data/scenes/furnished_room.toml --rig "
           "data/rigs/head_fs1500.toml --step-deg 12 "
           "--position-mm -1500 -300 1100 --out room",
           "facula extract room --out room.pcd",
           "facula map room.pcd --resolution-mm 100 --verify --out room.bt --out room.ot --grid "
           "room.yaml --min-height-m 0.1 --max-height-m 1.5"},
      .declare = [a](Arguments& arguments) { declare(arguments, *a); },
      .run = [a](Session& session) { run(*a, session); }};
}

}  // namespace facula
