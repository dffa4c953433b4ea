// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/apps/report/grid_layout.hpp>

#include <algorithm>

namespace facula {
namespace {

/// How many times `part` goes into `whole`, rounded up.
int times(int whole, int part) {
  return (whole + part - 1) / part;
}

}  // namespace

GridLayout grid_layout(int rows, int cols, const GridLayoutOptions& options) {
  require(rows >= 1 && cols >= 1,
          "a grid needs at least one row and one column to be drawn, not ",
          rows,
          " x ",
          cols);
  GridLayout layout{.rows = rows, .cols = cols};
  layout.step_x = times(cols, options.most);
  layout.step_y = times(rows, options.most);
  layout.scale_x = std::clamp(times(options.least, cols), 1, std::max(1, options.most / cols));
  layout.scale_y = std::clamp(times(options.least, rows), 1, std::max(1, options.most / rows));
  if (options.square_cells) {
    layout.step_x = layout.step_y = std::max(layout.step_x, layout.step_y);
    const int scale = times(options.least, std::min(rows, cols));
    const int most = std::max(1, options.most / std::max(rows, cols));
    layout.scale_x = layout.scale_y = std::clamp(scale, 1, most);
  }
  return layout;
}

Image8 paint_grid(const GridLayout& layout,
                  const std::function<Color(const CellBlock&)>& color_of) {
  Image8 picture = make_canvas(layout.height(), layout.width());
  for (int row = 0; row < layout.rows; row += layout.step_y) {
    for (int col = 0; col < layout.cols; col += layout.step_x) {
      const CellBlock block{row,
                            std::min(row + layout.step_y, layout.rows),
                            col,
                            std::min(col + layout.step_x, layout.cols)};
      const PixelBox box{col / layout.step_x * layout.scale_x,
                         row / layout.step_y * layout.scale_y,
                         layout.scale_x,
                         layout.scale_y};
      fill_box(picture, box, color_of(block));
    }
  }
  return picture;
}

}  // namespace facula
