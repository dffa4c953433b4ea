// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/apps/commands/measure_planes.hpp>
#include <facula/apps/commands/plane_figures.hpp>
#include <facula/apps/commands/plane_search.hpp>
#include <facula/apps/commands/tilt_zero_figures.hpp>

#include <memory>

namespace facula {
namespace {

struct PlaneArguments {
  PlaneSearch search;
  bool find_tilt_zero = false;
};

void declare(Arguments& arguments, PlaneArguments& a) {
  declare_plane_search(arguments, a.search);
  arguments.output("--out", a.search.csv, "as --csv, its older name");
  declare_shared_range(arguments, a.search);
  arguments.flag("--find-tilt-zero",
                 a.find_tilt_zero,
                 "find the tilt's zero of .csv lists by asking that the room be square");
}

void run(const PlaneArguments& a, Session& session) {
  if (a.find_tilt_zero) {
    report_tilt_zeros(a.search, session);
    return;
  }
  const FoundPlanes found = find_planes(a.search, session);
  if (!a.search.csv.empty()) write_planes_csv(a.search.csv, found.planes);
  report_planes(found.planes, session.figures, a.search.relations);
}

}  // namespace

Command measure_planes_command() {
  const auto a = std::make_shared<PlaneArguments>();
  return {
      .name = "measure planes",
      .summary = "find planes; sizes, angles, distances",
      .description =
          "Finds the planes in a cloud, largest first, fits each by least squares weighted by the "
          "points' sigma, and measures its scatter, the angle of every pair, and the distance of "
          "parallel pairs. rms is the standard deviation of the points about the plane, mean "
          "their mean absolute distance, p2v the largest minus the smallest distance, 4 sigma/D "
          "the "
          "system error of the scanner over its mean distance D. Slices of round surfaces are no "
          "planes. A .csv of range_mm, pan_deg, "
          "tilt_deg is read as a scan; --find-tilt-zero finds what its tilts lack.",
      .examples = {"facula simulate data/scenes/furnished_room.toml --rig "
                   "data/rigs/head_fs1500.toml --step-deg 3 "
                   "--position-mm -1500 -300 1100 --out room",
                   "facula extract room --out room.pcd",
                   "facula measure planes room.pcd --inlier-mm 20 --voxel-mm 50 --csv "
                   "planes.csv"},
      .declare = [a](Arguments& arguments) { declare(arguments, *a); },
      .run = [a](Session& session) { run(*a, session); }};
}

}  // namespace facula
