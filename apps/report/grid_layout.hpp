// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/apps/report/drawing.hpp>

#include <functional>

namespace facula {

/// How a grid of cells becomes pixels: small grids have several pixels per cell, large ones several
/// cells per pixel; whole numbers, so that no cell looks wider than its neighbour.
struct GridLayout {
  int rows = 0;     ///< cells [1]
  int cols = 0;     ///< cells [1]
  int scale_x = 1;  ///< pixels per cell [px]
  int scale_y = 1;  ///< pixels per cell [px]
  int step_x = 1;   ///< cells per pixel [1]
  int step_y = 1;   ///< cells per pixel [1]

  int width() const { return (cols + step_x - 1) / step_x * scale_x; }
  int height() const { return (rows + step_y - 1) / step_y * scale_y; }
  int x_of(int col) const { return col / step_x * scale_x + scale_x / 2; }
  int y_of(int row) const { return row / step_y * scale_y + scale_y / 2; }
};

struct GridLayoutOptions {
  int least = 420;            ///< shorter side aimed at for small grids [px]
  int most = 1200;            ///< longest side [px]
  bool square_cells = false;  ///< the same scale along both sides
};

/// A layout for a grid of rows x cols; both at least 1.
GridLayout grid_layout(int rows, int cols, const GridLayoutOptions& options = {});

/// Cells [row_begin, row_end) x [col_begin, col_end) that share one pixel.
struct CellBlock {
  int row_begin = 0;
  int row_end = 0;
  int col_begin = 0;
  int col_end = 0;
};

/// The grid as a picture; color_of is asked once per block.
Image8 paint_grid(const GridLayout& layout, const std::function<Color(const CellBlock&)>& color_of);

}  // namespace facula
