// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/apps/commands/map_scans.hpp>
#include <facula/apps/commands/octomap_log.hpp>
#include <facula/map/map_file.hpp>
#include <facula/map/octomap_judge.hpp>

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace facula {
namespace {

void require_points(std::size_t skipped, const PosedScans& scans, double resolution) {
  require(skipped < scans.points_read - scans.mixed_removed,
          "expected points within 32768 cells of the origin, got none at a cell of ",
          1000 * resolution,
          " mm; choose a larger --resolution-mm, or look at the scan with 'facula info'");
}

/// Names to know scans by later; files of the same name in different folders are numbered.
std::vector<std::string> distinct_names(const ScanProject& project) {
  std::vector<std::string> names;
  std::map<std::string, int> times;
  for (const PosedCloud& scan : project.scans) {
    const int number = ++times[scan.name];
    names.push_back(number == 1 ? scan.name : scan.name + " (" + std::to_string(number) + ")");
  }
  return names;
}

/// What became of the scans of an update.
struct Changes {
  std::size_t added = 0;
  std::size_t replaced = 0;
  std::size_t unchanged = 0;
  std::size_t bricks = 0;
};

/// What a scan puts into a map.
struct ScanParts {
  ScanRecord record;
  ScanCells cells;
  std::vector<ColorBrick> colors;
};

bool is_same(const KeptScan& kept, const ScanParts& scan) {
  return unpack(kept.cells).bricks == scan.cells.bricks &&
         unpack_colors(kept.colors) == scan.colors;
}

void update_scan(ScanMap& map, const ScanParts& scan, Changes& changes) {
  const auto kept = std::find_if(map.scans().begin(), map.scans().end(), [&](const KeptScan& one) {
    return one.record.name == scan.record.name;
  });
  if (kept == map.scans().end()) {
    map.add(scan.record, scan.cells, scan.colors);
    ++changes.added;
  } else if (is_same(*kept, scan)) {
    ++changes.unchanged;
  } else {
    changes.bricks += map.replace(scan.record, scan.cells, scan.colors).bricks;
    ++changes.replaced;
  }
}

}  // namespace

OccupancyMap map_of_scans(const PosedScans& scans,
                          const OccupancyOptions& options,
                          Session& session) {
  OccupancyMap map(options);
  const Progress progress = session.progress("casting rays");
  std::size_t done = 0;
  for (const PosedCloud& scan : scans.project.scans) {
    map.insert(in_world(scan));
    progress(++done, scans.project.scans.size());
  }
  session.figures.count("skipped_points", "points skipped", map.skipped_points());
  require_points(map.skipped_points(), scans, options.resolution);
  return map;
}

void verify_map(const OccupancyMap& map, const PosedScans& scans, Session& session) {
  OctomapJudge judge(map.options());
  const Progress progress = session.progress("liboctomap casts rays");
  std::size_t done = 0;
  for (const PosedCloud& scan : scans.project.scans) {
    judge.insert(in_world(scan));
    progress(++done, scans.project.scans.size());
  }
  const OctomapVerdict verdict = judge.verdict(map);
  require(verdict.same_ot && verdict.same_bt,
          "the map differs from liboctomap's of the same scans (",
          verdict.nodes,
          " nodes there); this is a defect of Facula: please report it with the scans");
  session.figures.flag("same_as_octomap", "same as liboctomap", true);
  session.figures.number("octomap_seconds", "liboctomap took, s", verdict.seconds, 3);
  session.figures.count("octomap_memory", "memory of its tree, bytes", verdict.memory);
}

void update_map(ScanMap& map, const PosedScans& scans, Session& session) {
  const CastOptions cast = map.map().options().cast();
  const Progress progress = session.progress("casting rays");
  const std::vector<std::string> names = distinct_names(scans.project);
  Changes changes;
  std::size_t done = 0;
  std::size_t skipped = 0;
  for (const PosedCloud& scan : scans.project.scans) {
    const PointCloud cloud = in_world(scan);
    const ScanParts parts{.record = {names[done], scan.world_from_scan, cloud.size(), cast},
                          .cells = cells_of_scan(cloud, cast),
                          .colors = colors_of_scan(cloud, cast)};
    skipped += parts.cells.skipped;
    update_scan(map, parts, changes);
    progress(++done, scans.project.scans.size());
  }
  session.figures.count("skipped_points", "points skipped", skipped);
  require_points(skipped, scans, cast.resolution);
  session.figures.count("scans_added", "scans added", changes.added);
  session.figures.count("scans_replaced", "scans replaced", changes.replaced);
  session.figures.count("scans_unchanged", "scans unchanged", changes.unchanged);
  session.figures.count("bricks_rebuilt", "bricks made again", changes.bricks);
}

ScanMap read_scan_map(const std::filesystem::path& file, int num_threads) {
  MapFile content = read_map_file(file);
  require(!content.scans.empty() || content.map.bricks().entries().empty(),
          "'",
          file.string(),
          "' keeps no scans, so none can be changed; make it of the scans again with 'facula map "
          "SCANS --out FILE.fmap'");
  OccupancyOptions options = content.map.options();
  options.num_threads = num_threads;
  OccupancyMap map(options);
  map.bricks() = std::move(content.map.bricks());
  map.colors() = std::move(content.map.colors());
  return {std::move(map), std::move(content.scans)};
}

void remove_scan(ScanMap& map, const std::string& name, Session& session) {
  session.figures.count("bricks_rebuilt", "bricks made again", map.remove(name).bricks);
  session.figures.count("scans_left", "scans left", map.scans().size());
}

}  // namespace facula
