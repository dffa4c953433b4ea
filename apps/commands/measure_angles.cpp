// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/apps/commands/csv_figures.hpp>
#include <facula/apps/commands/measure_angles.hpp>
#include <facula/apps/commands/relation_figures.hpp>

#include <memory>

namespace facula {
namespace {

struct AngleArguments {
  PlaneSearch search;
  std::size_t reference = 0;
  Eigen::Vector3d gravity = -Eigen::Vector3d::UnitZ();  ///< which way things fall
};

void declare(Arguments& arguments, AngleArguments& a) {
  declare_plane_search(arguments, a.search);
  declare_shared_range(arguments, a.search);
  arguments.whole("--reference", a.reference, "only angles to the plane of this number, 0 = all");
  arguments.vector("--gravity", a.gravity, kPlainNumber, "which way things fall, any length");
}

void run(const AngleArguments& a, Session& session) {
  require(a.gravity.allFinite() && a.gravity.norm() > 0,
          "expected a direction for --gravity, got one of length ",
          a.gravity.norm(),
          "; give for example 0 0 -1");
  const FoundPlanes found = find_planes(a.search, session);
  FigureTable angles = angle_table(found, a.reference, a.search.relations);
  if (!a.search.csv.empty()) write_table_csv(a.search.csv, angles);
  if (!angles.rows.empty()) session.figures.table(std::move(angles));
  session.figures.table(plumb_table(found, a.gravity, a.search.relations));
}

}  // namespace

Command measure_angles_command() {
  const auto a = std::make_shared<AngleArguments>();
  return {
      .name = "measure angles",
      .summary = "angles of planes to each other and to plumb",
      .description =
          "Finds the planes in a cloud and gives the angle of every pair with its standard "
          "uncertainty, the angle of the corner they make, and for pairs that are nearly parallel "
          "or square the width of the tolerance zone (ISO 1101) that holds the second about the "
          "first: of the fitted plane within its outline, and of the points, noise and form "
          "included. Then how far each plane leans from plumb or level. The uncertainties come "
          "from the points' sigma (from the scatter where there is none), taken as independent, "
          "and from the covariances of the scans' poses that poses.toml states; --shared-range-mm "
          "adds what all points have wrong alike.",
      .examples = {"facula simulate data/scenes/furnished_room.toml --rig "
                   "data/rigs/head_fs1500.toml --step-deg 3 "
                   "--position-mm -1500 -300 1100 --out room",
                   "facula extract room --out room.pcd",
                   "facula measure angles room.pcd --voxel-mm 50 --reference 1 --csv angles.csv"},
      .declare = [a](Arguments& arguments) { declare(arguments, *a); },
      .run = [a](Session& session) { run(*a, session); }};
}

}  // namespace facula
