// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/apps/cli/output_path.hpp>
#include <facula/apps/cli/usage_error.hpp>
#include <facula/apps/commands/csv_figures.hpp>
#include <facula/apps/commands/machine_memory.hpp>
#include <facula/apps/commands/map_plan.hpp>
#include <facula/apps/commands/path_table.hpp>
#include <facula/apps/report/path_picture.hpp>
#include <facula/apps/report/png.hpp>
#include <facula/map/path_plan.hpp>

#include <algorithm>
#include <limits>
#include <memory>
#include <string>

namespace facula {
namespace {

struct PlanArguments {
  std::filesystem::path map;
  std::optional<Eigen::Vector3d> from;
  std::optional<Eigen::Vector3d> to;
  std::string unknown = "blocked";
  std::size_t seed = 1;
  std::filesystem::path csv;
  std::filesystem::path picture;
  PathPlanOptions options;
};

void declare(Arguments& arguments, PlanArguments& a) {
  arguments.input("MAP", a.map, "a map (.bt, .ot, .fmap)");
  arguments.required();
  arguments.vector("--from-m", a.from, kMetres, "start, also --from X,Y,Z");
  arguments.required();
  arguments.also("--from");
  arguments.vector("--to-m", a.to, kMetres, "goal, also --to X,Y,Z");
  arguments.required();
  arguments.also("--to");
  arguments.number("--radius-m",
                   a.options.radius,
                   kMetres,
                   "of the ball that has to stay clear of obstacles, also --radius");
  arguments.also("--radius");
  arguments.choice("--unknown", a.unknown, {"blocked", "free"}, "what cells nobody has seen are");
  arguments.flag(
      "--flat", a.options.flat, "stay at the start's height, as robots on the ground do");
  arguments.whole("--seed", a.seed, "of the random tries: another one may find another path");
  arguments.whole("--max-tries", a.options.max_tries, "give up after so many");
  arguments.output("--csv", a.csv, "the path as places half a cell apart, with clearance (.csv)");
  arguments.output("--picture", a.picture, "the path over the map from above (.png)");
}

/// What the distance field may take: the search may need half as much again [bytes].
std::size_t memory_for_field() {
  constexpr double kShareOfMachine = 0.6;
  return static_cast<std::size_t>(kShareOfMachine * machine_memory());
}

void run(const PlanArguments& a, Session& session) {
  if (!a.csv.empty()) check_output(a.csv, {".csv"});
  if (!a.picture.empty()) check_output(a.picture, {".png"});
  PathPlanOptions options = a.options;
  options.unknown = a.unknown == "free" ? UnknownCells::kFree : UnknownCells::kOccupied;
  options.num_threads = session.num_threads;
  options.max_memory = std::min(options.max_memory, memory_for_field());
  if (a.seed == 0 || a.seed > std::numeric_limits<std::uint32_t>::max()) {
    fail_usage("--seed: expected a whole number from 1 to 4294967295, got ", a.seed);
  }
  options.seed = static_cast<std::uint32_t>(a.seed);
  options.check();
  const OccupancyMap map = OccupancyMap::read(a.map);
  const PathPlan plan = plan_path(map, *a.from, *a.to, options);
  // The picture first: where nothing can be drawn, nothing is left.
  if (!a.picture.empty()) write_png(a.picture, path_picture(map, plan, options.radius));
  if (!a.csv.empty()) write_table_csv(a.csv, path_table(plan));
  report_path(plan, session.figures);
  session.figures.count("corners", "corners", plan.corners.size());
  session.figures.count("paths", "paths found, this is the shortest", plan.paths);
  session.figures.count("tries", "random tries", plan.tries);
}

}  // namespace

Command map_plan_command() {
  const auto a = std::make_shared<PlanArguments>();
  return {.name = "map plan",
          .summary = "find a path through a map that keeps clear of obstacles",
          .description =
              "Finds a short path for a ball from one place of an occupancy map to another "
              "(RRT-Connect over an exact distance field, then shortened and smoothed). All of it "
              "keeps the radius from occupied cells, and from unknown ones unless these are free; "
              "every sample, half a cell apart, is checked against the map's cells. The same seed "
              "gives the same path.",
          .examples = {"facula simulate data/scenes/furnished_room.toml --rig "
                       "data/rigs/head_fs1500.toml --step-deg 12 "
                       "--position-mm -1500 -300 1100 --out room",
                       "facula extract room --out room.pcd",
                       "facula map room.pcd --resolution-mm 100 --out room.bt",
                       "facula map plan room.bt --from-m -1.3 -0.3 1.1 --to-m 0.5 -0.5 1.4 "
                       "--radius-m 0.25 --unknown free --csv path.csv --picture path.png"},
          .declare = [a](Arguments& arguments) { declare(arguments, *a); },
          .run = [a](Session& session) { run(*a, session); }};
}

}  // namespace facula
