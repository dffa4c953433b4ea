// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/apps/commands/csv_figures.hpp>
#include <facula/apps/commands/measure_distance.hpp>
#include <facula/apps/commands/relation_figures.hpp>

#include <memory>
#include <numbers>

namespace facula {
namespace {

struct DistanceArguments {
  PlaneSearch search;
  std::size_t reference = 0;
  double max_angle = 10 * kDegrees.factor;  ///< [rad]
};

void declare(Arguments& arguments, DistanceArguments& a) {
  declare_plane_search(arguments, a.search);
  declare_shared_range(arguments, a.search);
  arguments.whole(
      "--reference", a.reference, "only distances from the plane of this number, 0 = all");
  arguments.number("--parallel-deg", a.max_angle, kDegrees, "planes that open less are parallel");
}

void run(const DistanceArguments& a, Session& session) {
  require(a.max_angle > 0 && a.max_angle < std::numbers::pi / 2,
          "expected --parallel-deg above 0 and below 90, got ",
          a.max_angle / kDegrees.factor);
  const FoundPlanes found = find_planes(a.search, session);
  FigureTable table = distance_table(found, a.reference, a.max_angle, a.search.relations);
  require(!table.rows.empty(),
          "expected two planes that are parallel to ",
          a.max_angle / kDegrees.factor,
          " degrees, got none among ",
          found.planes.size(),
          "; raise --parallel-deg or lower --min-points");
  if (!a.search.csv.empty()) write_table_csv(a.search.csv, table);
  session.figures.table(std::move(table));
}

}  // namespace

Command measure_distance_command() {
  const auto a = std::make_shared<DistanceArguments>();
  return {
      .name = "measure distance",
      .summary = "distances of parallel planes",
      .description =
          "Finds the planes in a cloud and gives the distance of every parallel pair: of the "
          "second's centre from the first, with its standard uncertainty, which grows where the "
          "second lies beside the first's points and holds that of the scans' poses where "
          "poses.toml states it. --shared-range-mm adds what all ranges have wrong alike: it "
          "cancels in steps and counts twice between walls that face each other.",
      .examples = {"facula simulate data/scenes/furnished_room.toml --rig "
                   "data/rigs/head_fs1500.toml --step-deg 3 "
                   "--position-mm -1500 -300 1100 --out room",
                   "facula extract room --out room.pcd",
                   "facula measure distance room.pcd --voxel-mm 50 --shared-range-mm 1"},
      .declare = [a](Arguments& arguments) { declare(arguments, *a); },
      .run = [a](Session& session) { run(*a, session); }};
}

}  // namespace facula
