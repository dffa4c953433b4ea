// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/map/map_merge.hpp>
#include <facula/map/map_resample.hpp>

#include <algorithm>

namespace facula {
namespace {

/// The source's colours in the target's cells, a brick per coloured cell.
std::vector<ColorBrick> colors_in(const OccupancyMap& source, const ResampleGrid& grid) {
  std::vector<ColorBrick> result;
  for (const ColorBrick* brick : source.colors().sorted()) {
    const CellKey first = first_cell(brick->code);
    std::size_t rank = 0;
    for_each_cell(brick->cells, [&](std::size_t place) {
      const ColorSum& sum = brick->sums[rank++];
      const Eigen::Vector3d centre = centre_of(cell_at(first, place), source.resolution());
      const auto cell = cell_of(grid.target_from_source * centre, grid.resolution);
      if (!cell) return;
      ColorBrick& one = result.emplace_back();
      one.code = brick_code(*cell);
      one.cells.set(cell_in_brick(*cell));
      one.sums.push_back(sum);
    });
  }
  return result;
}

}  // namespace

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
  target.colors().add(colors_in(source, grid));
  return result;
}

}  // namespace facula
