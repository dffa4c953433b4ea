// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/apps/cli/usage_error.hpp>
#include <facula/apps/commands/occupancy_arguments.hpp>

namespace facula {

OccupancyOptions OccupancyArguments::with_box() const {
  if (box_min.has_value() != box_max.has_value()) {
    fail_usage("--box-min-m and --box-max-m are two corners of one box: expected both or none");
  }
  OccupancyOptions made = options;
  if (box_min) {
    if ((box_min->array() > box_max->array()).any()) {
      fail_usage("expected --box-min-m below --box-max-m along every axis");
    }
    made.box = MapBox{box_min->cast<float>(), box_max->cast<float>()};
  }
  return made;
}

void declare_occupancy(Arguments& arguments, OccupancyArguments& a) {
  OccupancyOptions& options = a.options;
  arguments.number("--resolution-mm", options.resolution, kMillimetres, "edge of a cell");
  arguments.number("--max-range-m",
                   options.max_range,
                   kMetres,
                   "longer rays only clear space up to here, 0 = no limit");
  arguments.vector("--box-min-m",
                   a.box_min,
                   kMetres,
                   "lowest corner of a box: only rays that end in it count, and only in it");
  arguments.vector("--box-max-m", a.box_max, kMetres, "its highest corner");
  arguments.number("--hit", options.hit, kPlainNumber, "probability of a cell a ray ends in");
  arguments.number("--miss", options.miss, kPlainNumber, "of a cell that a ray passes");
  arguments.number("--clamp-min", options.clamp_min, kPlainNumber, "least a cell can reach");
  arguments.number("--clamp-max", options.clamp_max, kPlainNumber, "most a cell can reach");
  arguments.flag("--discretize",
                 options.discretize,
                 "one ray per cell that points lie in, to its middle: faster, coarser");
  arguments.flag("--weigh-sigma",
                 options.weigh_sigma,
                 "points whose sigma is large against a cell hit it less; not as OctoMap does");
}

}  // namespace facula
