// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/map/cell_layers.hpp>
#include <facula/map/height_map.hpp>
#include <facula/map/plan_frame.hpp>

#include <cmath>

namespace facula {
namespace {

/// Layers whose upper face is at most `max_height`.
CellLayers layers_below(double max_height, double resolution) {
  const CellLayers touched =
      layers_between(-std::numeric_limits<double>::infinity(), max_height, resolution);
  const double top = (touched.end - kCentreKey) * resolution;
  return {touched.begin, top > max_height + 1e-6 * resolution ? touched.end - 1 : touched.end};
}

}  // namespace

void HeightMapOptions::check() const {
  require(!std::isnan(max_height), "HeightMapOptions: expected max_height to be a number");
}

HeightMap height_map(const OccupancyMap& map, const HeightMapOptions& options) {
  options.check();
  const double resolution = map.resolution();
  const CellLayers layers = layers_below(options.max_height, resolution);
  const auto frame = plan_frame(map, [&](const OccupancyMap::BrickView& brick) {
    return brick.known & mask_of(layers, brick.first[2]);
  });
  require(frame.has_value(),
          "the map knows nothing below the height ",
          options.max_height,
          " m; choose a height that the scans have seen");
  HeightMap heights{.rows = frame->rows,
                    .cols = frame->cols,
                    .resolution = resolution,
                    .origin = frame->origin(),
                    .top = {}};
  heights.top.assign(frame->size(), std::numeric_limits<float>::quiet_NaN());
  map.for_each_brick([&](const OccupancyMap::BrickView& brick) {
    for_each_cell(brick.occupied & mask_of(layers, brick.first[2]), [&](std::size_t cell) {
      const auto [x, y, z] = cell_at(brick.first, cell);
      const auto top = static_cast<float>((z + 1 - kCentreKey) * resolution);
      float& highest = heights.top[frame->index(x, y)];
      if (!(highest >= top)) highest = top;
    });
  });
  return heights;
}

}  // namespace facula
