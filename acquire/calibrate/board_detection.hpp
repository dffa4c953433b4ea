// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/calibrate/board.hpp>
#include <facula/acquire/core/image_view.hpp>

#include <optional>
#include <vector>

#include <Eigen/Core>

namespace facula {

/// Points of a grid, row by row, as they were seen.
struct GridSeen {
  int cols = 0;                         ///< [1]
  int rows = 0;                         ///< [1]
  std::vector<Eigen::Vector2d> pixels;  ///< [px]
};

/// The inner corners of a chessboard of this many columns and rows, sub-pixel; none when there is
/// no such chessboard. `grey` has one channel, in this and the functions below.
std::optional<GridSeen> find_chessboard(ImageView8 grey, int cols, int rows);

/// The largest part of any chessboard in sight, at least 3 x 3 corners.
std::optional<GridSeen> find_any_chessboard(ImageView8 grey);

/// The centres of a grid of dark circles.
std::optional<GridSeen> find_circle_grid(ImageView8 grey, const Board& board);

/// The largest grid of dark circles that is not the one asked for.
std::optional<GridSeen> find_any_circle_grid(ImageView8 grey, const Board& board);

/// Corners of a ChArUco board by id, and how many markers of its dictionary were read.
struct CharucoSeen {
  std::vector<int> ids;                 ///< ascending [1]
  std::vector<Eigen::Vector2d> pixels;  ///< [px]
  int markers = 0;                      ///< [1]
};
CharucoSeen find_charuco(ImageView8 grey, const Board& board);

/// 10 % to 90 % width of the edges between the points of a view [px]: the median over up to 200
/// edges, 0 where there is none to measure.
double edge_width(ImageView8 grey, const Board& board, const BoardView& view);

/// Share of the pixels within the board's outer points that are 255 in the grey picture [0..1].
double clipped_share(ImageView8 grey, const BoardView& view);

}  // namespace facula
