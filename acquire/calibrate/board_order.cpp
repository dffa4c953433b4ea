// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/calibrate/board_order.hpp>

#include <algorithm>
#include <cmath>

namespace facula {
namespace {

const Eigen::Vector2d& at(const GridSeen& grid, int row, int col) {
  return grid.pixels[static_cast<std::size_t>(row * grid.cols + col)];
}

Eigen::Vector2d along_rows(const GridSeen& grid) {
  return at(grid, 0, grid.cols - 1) - at(grid, 0, 0) + at(grid, grid.rows - 1, grid.cols - 1) -
         at(grid, grid.rows - 1, 0);
}

Eigen::Vector2d along_cols(const GridSeen& grid) {
  return at(grid, grid.rows - 1, 0) - at(grid, 0, 0) + at(grid, grid.rows - 1, grid.cols - 1) -
         at(grid, 0, grid.cols - 1);
}

double handedness(const GridSeen& grid) {
  const Eigen::Vector2d x = along_rows(grid);
  const Eigen::Vector2d y = along_cols(grid);
  return x.x() * y.y() - x.y() * y.x();
}

void mirror(GridSeen& grid) {
  for (int r = 0; r < grid.rows; ++r) {
    const auto row = grid.pixels.begin() + static_cast<std::ptrdiff_t>(r) * grid.cols;
    std::reverse(row, row + grid.cols);
  }
}

/// By a quarter, for grids of as many rows as columns.
void turn_quarter(GridSeen& grid) {
  const std::vector<Eigen::Vector2d> before = grid.pixels;
  const int n = grid.cols;
  for (int r = 0; r < n; ++r) {
    for (int c = 0; c < n; ++c) {
      grid.pixels[static_cast<std::size_t>(r * n + c)] =
          before[static_cast<std::size_t>((n - 1 - c) * n + r)];
    }
  }
}

double level(ImageView8 grey, const Eigen::Vector2d& p) {
  const int c = std::clamp(static_cast<int>(std::lround(p.x())), 0, grey.cols - 1);
  const int r = std::clamp(static_cast<int>(std::lround(p.y())), 0, grey.rows - 1);
  return grey.row(r)[c];
}

/// Brightness of the squares down-right of the points of even row + col, less that of the others;
/// below 0 when the first square of the board is black.
double first_square(ImageView8 grey, const GridSeen& grid) {
  double sum = 0;
  for (int r = 0; r + 1 < grid.rows; ++r) {
    for (int c = 0; c + 1 < grid.cols; ++c) {
      const Eigen::Vector2d middle =
          (at(grid, r, c) + at(grid, r, c + 1) + at(grid, r + 1, c) + at(grid, r + 1, c + 1)) / 4;
      sum += ((r + c) % 2 == 0 ? 1 : -1) * level(grey, middle);
    }
  }
  return sum;
}

/// Turns a grid that looks the same after it so that its rows run to the right.
void turn_upright(GridSeen& grid, bool quarters) {
  for (int k = 0; quarters && k < 3; ++k) {
    const Eigen::Vector2d x = along_rows(grid);
    if (x.x() >= std::abs(x.y())) return;
    turn_quarter(grid);
  }
  if (!quarters && along_rows(grid).x() < 0) std::reverse(grid.pixels.begin(), grid.pixels.end());
}

}  // namespace

bool order_like_board(ImageView8 grey, const Board& board, GridSeen& grid) {
  const bool square = grid.cols == grid.rows;
  if (board.kind == BoardKind::kAsymmetricCircles) {
    // With an odd number of rows the print is its own mirror image, upside down.
    if (handedness(grid) > 0) return true;
    if (grid.rows % 2 == 0) return false;
    for (int r = 0; r < grid.rows / 2; ++r) {
      const auto row = grid.pixels.begin() + static_cast<std::ptrdiff_t>(r) * grid.cols;
      const auto other =
          grid.pixels.begin() + static_cast<std::ptrdiff_t>(grid.rows - 1 - r) * grid.cols;
      std::swap_ranges(row, row + grid.cols, other);
    }
    return true;
  }
  if (handedness(grid) < 0) mirror(grid);
  if (board.kind == BoardKind::kCircles) {
    turn_upright(grid, square);
    return true;
  }
  if ((grid.cols + grid.rows) % 2 == 1) {
    if (first_square(grey, grid) > 0) std::reverse(grid.pixels.begin(), grid.pixels.end());
    return true;
  }
  if (square && first_square(grey, grid) > 0) turn_quarter(grid);
  // With all four corner squares alike a quarter turn is open as well.
  turn_upright(grid, square && grid.cols % 2 == 0);
  return true;
}

}  // namespace facula
