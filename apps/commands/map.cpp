// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/apps/cli/file_kind.hpp>
#include <facula/apps/cli/output_path.hpp>
#include <facula/apps/cli/usage_error.hpp>
#include <facula/apps/commands/map.hpp>
#include <facula/apps/commands/map_figures.hpp>
#include <facula/apps/commands/map_outputs.hpp>
#include <facula/apps/commands/occupancy_arguments.hpp>
#include <facula/apps/commands/place_scans.hpp>
#include <facula/apps/commands/posed_scans.hpp>
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
  std::string place = "auto";
  bool verify = false;
  OccupancyOptions options;
  MapOutputs outputs;
};

void declare(Arguments& arguments, MapArguments& a) {
  arguments.inputs("SCANS",
                   a.scans,
                   "a scan, several, a project (poses.toml, .conf, folder), or a finished map");
  arguments.required();
  arguments.outputs("--out", a.out, "the map: .bt (free or occupied) or .ot (probabilities)");
  declare_occupancy(arguments, a.options);
  arguments.choice("--register",
                   a.place,
                   {"auto", "always", "never"},
                   "find the poses of the scans; auto: of scans that have none");
  arguments.flag(
      "--verify", a.verify, "build the map once more with liboctomap and compare every byte");
  declare_map_outputs(arguments, a.outputs);
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

/// A map that is finished already, when it is what the command was given.
std::optional<OccupancyMap> finished_map(const MapArguments& a) {
  if (a.scans.size() != 1 || file_kind(a.scans[0]) != FileKind::kMap) return std::nullopt;
  if (a.verify) fail_usage("--verify needs the scans; '", a.scans[0].string(), "' is a map");
  return OccupancyMap::read(a.scans[0]);
}

void check(const MapArguments& a) {
  for (const auto& path : a.out) check_output(path, {".bt", ".ot"});
  check_map_outputs(a.outputs);
  if (a.out.empty() && !a.outputs.any()) {
    fail_usage("expected something to write: --out, --grid, --height-map or --frontiers");
  }
  if (a.verify && a.options.weigh_sigma) {
    fail_usage("--verify and --weigh-sigma exclude each other: OctoMap does not weigh hits");
  }
  a.options.check();
}

void run(const MapArguments& a, Session& session) {
  check(a);
  std::optional<OccupancyMap> map = finished_map(a);
  if (!map) {
    map = build_map(a, session);
    session.figures.count("skipped_points", "points skipped", map->skipped_points());
  }
  for (const auto& path : a.out) map->write(path);
  report_map(*map, session.figures);
  write_map_outputs(*map, a.outputs, session);
}

}  // namespace

Command map_command() {
  const auto a = std::make_shared<MapArguments>();
  return {
      .name = "map",
      .summary = "make an occupancy map, grids, and plans of where to scan next",
      .description =
          "Casts a ray from the scanner to every point and marks the cells of space as free, "
          "occupied or unknown (OctoMap). A grid is the map seen from above, as ROS map servers "
          "read it; a height map is its highest surface; frontiers are where the known free space "
          "ends, with the places from which a scan would see most behind them. They can also be "
          "made of a finished map.",
      .examples =
          {"facula simulate data/scenes/furnished_room.toml --rig "
           "data/rigs/head_fs1500.toml --step-deg 12 "
           "--position-mm -1500 -300 1100 --out room",
           "facula extract room --out room.pcd",
           "facula map room.pcd --resolution-mm 100 --verify --out room.bt --out room.ot --grid "
           "room.yaml --min-height-m 0.1 --max-height-m 1.5",
           "facula map room.bt --above-floor --grid raw.yaml --grid-mode raw --inflate-m 0.2 "
           "--height-map heights.tif --frontiers next.csv --frontiers next.png --scanner-range-m 5 "
           "--scanner-height-m 1.1"},
      .declare = [a](Arguments& arguments) { declare(arguments, *a); },
      .run = [a](Session& session) { run(*a, session); }};
}

}  // namespace facula
