// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/apps/commands/occupancy_arguments.hpp>

namespace facula {

void declare_occupancy(Arguments& arguments, OccupancyOptions& options) {
  arguments.number("--resolution-mm", options.resolution, kMillimetres, "edge of a cell");
  arguments.number("--max-range-m",
                   options.max_range,
                   kMetres,
                   "longer rays only clear space up to here, 0 = no limit");
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
