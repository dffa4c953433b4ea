// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/apps/report/color_bar.hpp>
#include <facula/apps/report/legend.hpp>
#include <facula/apps/report/number_format.hpp>
#include <facula/apps/report/plot_axes.hpp>
#include <facula/apps/report/range_image.hpp>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace facula {
namespace {

/// Distance of every cell from its column's sensor origin [m]; NaN where there is no point.
std::vector<float> distances_from_sensor(const PolarScan& scan) {
  std::vector<float> distances(scan.point.size(), std::numeric_limits<float>::quiet_NaN());
  for (int col = 0; col < scan.cols; ++col) {
    const Eigen::Vector3d& origin = scan.sensor_origin[static_cast<std::size_t>(col)];
    for (int row = 0; row < scan.rows; ++row) {
      const std::size_t cell = scan.index(row, col);
      if (scan.valid[cell] == 0) continue;
      distances[cell] = static_cast<float>((scan.point[cell].cast<double>() - origin).norm());
    }
  }
  return distances;
}

/// The first cell of the block that has a point, so that thin things stay visible.
float first_in_block(const PolarScan& scan,
                     const std::vector<float>& values,
                     const CellBlock& block) {
  for (int col = block.col_begin; col < block.col_end; ++col) {
    for (int row = block.row_begin; row < block.row_end; ++row) {
      const float value = values[scan.index(row, col)];
      if (std::isfinite(value)) return value;
    }
  }
  return std::numeric_limits<float>::quiet_NaN();
}

}  // namespace

GridLayout range_image_layout(const PolarScan& scan) {
  return grid_layout(scan.rows, scan.cols, {.least = 460, .most = 1150});
}

Image8 range_image(const PolarScan& scan) {
  scan.check();
  if (scan.rows < 1 || scan.cols < 1) return empty_picture("The scan has no cells.");
  const std::vector<float> distances = distances_from_sensor(scan);
  if (scan.valid_count() == 0) return empty_picture("No cell of the scan holds a point.");

  const ValueRange range = robust_range(distances);
  const LengthUnit unit = length_unit_for(range.high);
  const ColorScale scale{ColorMap::kViridis,
                         range.low * unit.per_metre,
                         range.high * unit.per_metre,
                         std::string("distance [") + unit.name + "]"};
  const GridLayout layout = range_image_layout(scan);
  const Image8 cells = paint_grid(layout, [&](const CellBlock& block) {
    return scale.at(first_in_block(scan, distances, block) * unit.per_metre);
  });
  Image8 plot = make_plot(cells.rows, cells.cols);
  paste(plot, cells, kPlotMargin.x, kPlotMargin.y);
  draw_axes(plot,
            {-0.5, scan.cols - 0.5, "column (axis position) [1]"},
            {scan.rows - 0.5, -0.5, "row [1]"});
  return beside({plot, color_bar(scale, plot.rows - kPlotMargin.height + 14)});
}

}  // namespace facula
