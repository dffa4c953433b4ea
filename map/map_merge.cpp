// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/map/map_merge.hpp>
#include <facula/map/map_resample.hpp>

#include <algorithm>

namespace facula {

MapMerge merge_map(OccupancyMap& target,
                   const OccupancyMap& source,
                   const RigidTransform& target_from_source) {
  const ResampleGrid grid{.resolution = target.resolution(),
                          .target_from_source = target_from_source,
                          .num_threads = target.options().num_threads};
  const LogOddsModel model = target.options().model();
  MapMerge result{.exact = fits_cells(source, grid)};
  for_each_resampled(source, grid, [&](const ResampledBrick& theirs) {
    LogOddsBrick& ours = target.bricks().find_or_add(theirs.code);
    LogOddsBrick::Values values{};
    const CellMask known = ours.read(values);
    for_each_cell(theirs.known, [&](std::size_t cell) {
      values[cell] = std::clamp(values[cell] + theirs.values[cell], model.min, model.max);
    });
    const auto joined = static_cast<std::size_t>((known & theirs.known).count());
    result.joined_cells += joined;
    result.new_cells += static_cast<std::size_t>(theirs.known.count()) - joined;
    ours.assign(values, known | theirs.known);
  });
  return result;
}

}  // namespace facula
