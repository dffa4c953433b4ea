// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/cloud_file.hpp>
#include <facula/apps/cli/output_path.hpp>
#include <facula/apps/cli/usage_error.hpp>
#include <facula/apps/commands/csv_figures.hpp>
#include <facula/apps/commands/map_diff.hpp>
#include <facula/apps/commands/map_pose.hpp>
#include <facula/map/map_diff.hpp>

#include <algorithm>
#include <memory>
#include <string>

namespace facula {
namespace {

/// Clusters that are listed; the table file has all.
constexpr std::size_t kListed = 20;

struct DiffArguments {
  std::vector<std::filesystem::path> maps;
  std::filesystem::path out;
  std::filesystem::path csv;
  MapPoseArguments pose;
  MapDiffOptions options;
};

void declare(Arguments& arguments, DiffArguments& a) {
  arguments.inputs("MAPS",
                   a.maps,
                   "two maps (.bt, .ot, .fmap) of one place: before, whose frame and cells are "
                   "used, and after");
  arguments.required();
  declare_map_pose(arguments, a.pose);
  arguments.whole("--slack-cells",
                  a.options.slack_cells,
                  "what was as near as this has not changed, so that noise of surfaces and poses "
                  "is no change");
  arguments.whole("--min-cells", a.options.min_cells, "smaller clusters are left out");
  arguments.flag("--newly-seen",
                 a.options.newly_seen,
                 "also list what is occupied now where nobody had looked before");
  arguments.output("--out",
                   a.out,
                   "changed cells as points (.ply): green appeared, red vanished, blue newly seen");
  arguments.output("--csv", a.csv, "all clusters as a table (.csv)");
}

FigureTable table_of(const MapDiff& diff, std::size_t rows) {
  FigureTable table{"clusters",
                    "Changes, the largest first:",
                    {{"change", "change", 0},
                     {"cells", "cells", 0},
                     {"volume_m3", "volume", 4},
                     {"x_m", "x", 2},
                     {"y_m", "y", 2},
                     {"z_m", "z", 2},
                     {"min_x_m", "from x", 2},
                     {"min_y_m", "y", 2},
                     {"min_z_m", "z", 2},
                     {"max_x_m", "to x", 2},
                     {"max_y_m", "y", 2},
                     {"max_z_m", "z", 2}},
                    {}};
  for (std::size_t i = 0; i < std::min(rows, diff.clusters.size()); ++i) {
    const ChangeCluster& cluster = diff.clusters[i];
    std::vector<FigureValue> row = {
        to_string(cluster.kind), static_cast<long long>(cluster.cells), cluster.volume};
    for (const Eigen::Vector3d& x : {cluster.centre, cluster.min, cluster.max}) {
      row.insert(row.end(), {x.x(), x.y(), x.z()});
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

void report(const MapDiff& diff, Figures& figures) {
  figures.count("compared_cells", "cells known in both", diff.compared_cells);
  figures.count("changed_cells", "cells changed", diff.cells.size());
  figures.count("left_out_cells", "cells of clusters too small", diff.left_out_cells);
  figures.count("cluster_count", "clusters", diff.clusters.size());
  if (diff.clusters.empty()) return;
  figures.table(table_of(diff, kListed));
  if (diff.clusters.size() > kListed) {
    figures.note(std::to_string(diff.clusters.size() - kListed) +
                 " smaller clusters are not listed; --csv has all.");
  }
}

void run(const DiffArguments& a, Session& session) {
  if (!a.out.empty()) check_output(a.out, {".ply"});
  if (!a.csv.empty()) check_output(a.csv, {".csv"});
  if (a.maps.size() != 2) {
    fail_usage("expected two maps, got " + std::to_string(a.maps.size()) + "; see --help");
  }
  MapDiffOptions options = a.options;
  options.num_threads = session.num_threads;
  options.check();
  session.step("reading", 1, 3);
  const OccupancyMap before = OccupancyMap::read(a.maps[0]);
  const OccupancyMap after = OccupancyMap::read(a.maps[1]);
  session.step("comparing", 2, 3);
  const MapDiff diff = diff_maps(before, after, pose_of(a.pose), options);
  session.step("writing", 3, 3);
  const bool changed = !diff.cells.empty();
  if (!a.out.empty() && changed) write_cloud(a.out, cloud_of_changes(diff));
  if (!a.csv.empty()) write_table_csv(a.csv, table_of(diff, diff.clusters.size()));
  session.end_steps();
  report(diff, session.figures);
  if (a.out.empty() || changed) return;
  session.figures.note("Nothing has changed: '" + a.out.string() + "' was not written.");
}

}  // namespace

Command map_diff_command() {
  const auto a = std::make_shared<DiffArguments>();
  return {.name = "map diff",
          .summary = "what appeared and what vanished between two occupancy maps",
          .description =
              "Compares two maps, the second one placed by a pose: what was free and is occupied "
              "has appeared, what was occupied and is free has vanished; what one of them does not "
              "know is not compared. Changed cells that touch are one cluster.",
          .examples = {"facula simulate data/scenes/flat_wall.toml --rig "
                       "data/rigs/head_fs1500.toml --step-deg 24 --out wall",
                       "facula extract wall --out wall.pcd",
                       "facula map wall.pcd --resolution-mm 100 --out wall.bt",
                       "facula map diff wall.bt wall.bt --position-mm 400 0 0 --newly-seen --out "
                       "changes.ply --csv changes.csv"},
          .declare = [a](Arguments& arguments) { declare(arguments, *a); },
          .run = [a](Session& session) { run(*a, session); }};
}

}  // namespace facula
