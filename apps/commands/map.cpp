// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/apps/cli/file_kind.hpp>
#include <facula/apps/cli/output_path.hpp>
#include <facula/apps/cli/usage_error.hpp>
#include <facula/apps/commands/map.hpp>
#include <facula/apps/commands/map_figures.hpp>
#include <facula/apps/commands/map_outputs.hpp>
#include <facula/apps/commands/map_scans.hpp>
#include <facula/apps/commands/occupancy_arguments.hpp>
#include <facula/apps/commands/octomap_log.hpp>
#include <facula/apps/commands/place_scans.hpp>
#include <facula/apps/commands/posed_scans.hpp>
#include <facula/map/map_file.hpp>
#include <facula/map/occupancy_map.hpp>

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <tuple>

namespace facula {
namespace {

struct MapArguments {
  std::vector<std::filesystem::path> scans;
  std::vector<std::filesystem::path> out;
  std::filesystem::path update;
  std::string remove;
  std::string place = "auto";
  bool verify = false;
  OccupancyArguments occupancy;
  MapOutputs outputs;
};

void declare(Arguments& arguments, MapArguments& a) {
  arguments.inputs("SCANS",
                   a.scans,
                   "a scan, several, a project (poses.toml, .conf, folder), or a finished map");
  arguments.required();
  arguments.outputs("--out",
                    a.out,
                    "the map: .bt (free or occupied), .ot (probabilities), or .fmap (both and the "
                    "scans, so that they can be changed later)");
  arguments.input("--update",
                  a.update,
                  "a .fmap to bring up to date: scans of new names are added, those that changed "
                  "or stand elsewhere replaced; its cells and sensor model stay");
  arguments.word("--remove", a.remove, "take the scan of this name out of a .fmap");
  declare_occupancy(arguments, a.occupancy);
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

bool wants(const MapArguments& a, const char* extension) {
  return std::any_of(a.out.begin(), a.out.end(), [&](const std::filesystem::path& path) {
    return path.extension() == extension;
  });
}

/// Whether the command was given a map that is finished already.
bool is_finished(const MapArguments& a) {
  return a.scans.size() == 1 && file_kind(a.scans[0]) == FileKind::kMap;
}

/// The map and, for .fmap and .graph files, the scans behind it.
struct MadeMap {
  OccupancyMap map;
  std::vector<KeptScan> scans = {};
  ScanGraph log = {};
};

MadeMap parts_of(ScanMap map) {
  auto [occupancy, scans] = std::move(map).release();
  return {std::move(occupancy), std::move(scans)};
}

MadeMap changed_map(const MapArguments& a, Session& session) {
  ScanMap map = read_scan_map(is_finished(a) ? a.scans[0] : a.update, session.num_threads);
  if (!a.remove.empty()) remove_scan(map, a.remove, session);
  if (!is_finished(a)) update_map(map, read_scans(a, session), session);
  return parts_of(std::move(map));
}

MadeMap make_map(const MapArguments& a, Session& session) {
  if (!a.update.empty() || !a.remove.empty()) return changed_map(a, session);
  if (is_finished(a)) {
    if (a.scans[0].extension() != ".fmap") return {OccupancyMap::read(a.scans[0])};
    MapFile file = read_map_file(a.scans[0]);
    return {std::move(file.map), std::move(file.scans)};
  }
  OccupancyOptions options = a.occupancy.with_box();
  options.num_threads = session.num_threads;
  const PosedScans scans = read_scans(a, session);
  MadeMap made;
  if (wants(a, ".fmap")) {
    ScanMap map(options);
    update_map(map, scans, session);
    made = parts_of(std::move(map));
  } else {
    made.map = map_of_scans(scans, options, session);
  }
  if (wants(a, ".graph")) made.log = log_of(scans.project);
  if (a.verify) verify_map(made.map, scans, session);
  return made;
}

/// Cells and sensor model belong to a map: a finished one is not made again with others.
void check_sensor_model(const MapArguments& a) {
  const auto told = [](const OccupancyArguments& asked) {
    const OccupancyOptions& o = asked.options;
    return std::tuple(asked.box_min,
                      asked.box_max,
                      o.resolution,
                      o.max_range,
                      o.hit,
                      o.miss,
                      o.clamp_min,
                      o.clamp_max,
                      o.discretize,
                      o.weigh_sigma);
  };
  if ((is_finished(a) || !a.update.empty()) && told(a.occupancy) != told({})) {
    fail_usage(
        "a finished map keeps its cells and sensor model; leave out --resolution-mm, "
        "--max-range-m, --box-min-m, --box-max-m, --hit, --miss, --clamp-min, --clamp-max, "
        "--discretize and --weigh-sigma, "
        "or make the map of its scans again");
  }
}

void check(const MapArguments& a) {
  for (const auto& path : a.out) check_output(path, {".bt", ".ot", ".fmap", ".graph"});
  check_map_outputs(a.outputs);
  if (a.out.empty() && !a.outputs.any()) {
    fail_usage("expected something to write: --out, --grid, --height-map or --frontiers");
  }
  if (a.verify && a.occupancy.options.weigh_sigma) {
    fail_usage("--verify and --weigh-sigma exclude each other: OctoMap does not weigh hits");
  }
  if (a.verify && (is_finished(a) || !a.update.empty())) {
    fail_usage("--verify needs all the scans, and a map made of them alone");
  }
  if (wants(a, ".graph") && (is_finished(a) || !a.update.empty())) {
    fail_usage("a .graph holds the points of scans, which maps do not keep; give the scans alone");
  }
  if (!a.update.empty() && is_finished(a)) {
    fail_usage("--update takes scans, got the finished map '",
               a.scans[0].string(),
               "'; 'facula map merge' adds two maps");
  }
  if (!a.remove.empty() && a.update.empty() && !is_finished(a)) {
    fail_usage("--remove needs a map that keeps its scans: give a .fmap file, or --update one");
  }
  a.occupancy.with_box().check();
  check_sensor_model(a);
}

void write_map(const std::filesystem::path& path, const MadeMap& made) {
  if (path.extension() == ".fmap") return write_map_file(path, made.map, made.scans);
  if (path.extension() == ".graph") return write_scan_graph(path, made.log);
  made.map.write(path);
}

void run(const MapArguments& a, Session& session) {
  check(a);
  const MadeMap made = make_map(a, session);
  report_map(made.map, session.figures);
  write_map_outputs(made.map, a.outputs, session);  // first: where they cannot be, nothing is left
  for (std::size_t i = 0; i < a.out.size(); ++i) {
    write_map(a.out[i], made);
    session.figures.text("out_" + std::to_string(i + 1), "written", a.out[i].string());
  }
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
           "facula map room.bt --above-floor --floor-m 0 --grid raw.yaml --grid-mode raw "
           "--inflate-m 0.2 "
           "--height-map heights.tif --frontiers next.csv --frontiers next.png --scanner-range-m 5 "
           "--scanner-height-m 1.1",
           "facula map room.pcd --resolution-mm 100 --out room.fmap",
           "facula map room.pcd --update room.fmap --out room.fmap --json -"},
      .declare = [a](Arguments& arguments) { declare(arguments, *a); },
      .run = [a](Session& session) { run(*a, session); }};
}

}  // namespace facula
