// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/apps/cli/output_path.hpp>
#include <facula/apps/cli/usage_error.hpp>
#include <facula/apps/commands/map_figures.hpp>
#include <facula/apps/commands/map_merge.hpp>
#include <facula/apps/commands/map_pose.hpp>
#include <facula/map/map_merge.hpp>

#include <memory>
#include <string>

namespace facula {
namespace {

struct MergeArguments {
  std::vector<std::filesystem::path> maps;
  std::vector<std::filesystem::path> out;
  MapPoseArguments pose;
};

void declare(Arguments& arguments, MergeArguments& a) {
  arguments.inputs("MAPS",
                   a.maps,
                   "two maps (.bt, .ot, .fmap): the second is added to the first, whose frame and "
                   "cells are kept");
  arguments.required();
  arguments.outputs("--out", a.out, "the merged map (.bt, .ot, .fmap)");
  arguments.required();
  declare_map_pose(arguments, a.pose);
}

void run(const MergeArguments& a, Session& session) {
  for (const auto& path : a.out) check_output(path, {".bt", ".ot", ".fmap"});
  if (a.maps.size() != 2) {
    fail_usage("expected two maps, got " + std::to_string(a.maps.size()) + "; see --help");
  }
  session.step("reading", 1, 3);
  OccupancyMap map = OccupancyMap::read(a.maps[0]);
  const OccupancyMap second = OccupancyMap::read(a.maps[1]);
  session.step("merging", 2, 3);
  const MapMerge merge = merge_map(map, second, pose_of(a.pose));
  session.step("writing", 3, 3);
  for (const auto& path : a.out) map.write(path);
  session.end_steps();
  session.figures.flag("exact", "cell on cell", merge.exact);
  session.figures.count("joined_cells", "cells known in both", merge.joined_cells);
  session.figures.count("new_cells", "cells of the second map alone", merge.new_cells);
  report_map(map, session.figures);
}

}  // namespace

Command map_merge_command() {
  const auto a = std::make_shared<MergeArguments>();
  return {.name = "map merge",
          .summary = "add one occupancy map to another",
          .description =
              "Adds the log-odds of two maps, cell by cell, the second one placed by a pose. At "
              "shifts by whole cells (and turns by right angles) every cell meets one cell; "
              "otherwise the second map is resampled, which moves its surfaces by up to half a "
              "cell. A merged map keeps no scans.",
          .examples = {"facula simulate data/scenes/flat_wall.toml --rig "
                       "data/rigs/head_fs1500.toml --step-deg 24 --out wall",
                       "facula extract wall --out wall.pcd",
                       "facula map wall.pcd --resolution-mm 100 --out wall.ot",
                       "facula map merge wall.ot wall.ot --position-mm 0 2000 0 --out both.ot "
                       "--out both.fmap"},
          .declare = [a](Arguments& arguments) { declare(arguments, *a); },
          .run = [a](Session& session) { run(*a, session); }};
}

}  // namespace facula
