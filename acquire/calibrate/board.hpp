// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/image_view.hpp>

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace facula {

enum class BoardKind {
  kChessboard,         ///< inner corners, row by row
  kCircles,            ///< symmetric grid of circles
  kAsymmetricCircles,  ///< every other row shifted by half a spacing (OpenCV's acircles)
  kCharuco             ///< chessboard with ArUco markers in its white squares
};

/// A flat calibration target. Board frame: x along a row, y from row to row, z = 0 on the board, z
/// into it (as the camera looks). Point 0 is the origin.
struct Board {
  BoardKind kind = BoardKind::kChessboard;
  int cols = 9;            ///< points in a row: inner corners or circles (asymmetric: per row) [1]
  int rows = 6;            ///< [1]
  double spacing = 0.025;  ///< between neighbouring points of a row [m]; asymmetric circles: half
                           ///< of it, as OpenCV counts: x = (2 col + row % 2) spacing
  double circle_diameter = 0;  ///< 0 = not known: the bias of the circles' centres stays in; where
                               ///< a picture is made, half a spacing [m]
  double marker_size = 0;      ///< side of a ChArUco marker, 0 = 0.8 spacing [m]
  std::string dictionary = "4x4_50";  ///< of a ChArUco board: "4x4_50" ... "7x7_1000"

  std::size_t size() const {
    return static_cast<std::size_t>(cols) * static_cast<std::size_t>(rows);
  }

  /// Point `id` (row * cols + col) in the board frame [m].
  Eigen::Vector3d point(int id) const;

  double marker_side() const { return marker_size > 0 ? marker_size : 0.8 * spacing; }

  /// Distance of a point to its nearest neighbour [m].
  double pitch() const;

  /// The corners of the rectangle `margin` pitches outside the outer points, in order round it [m].
  std::array<Eigen::Vector3d, 4> outline(double margin) const;

  /// Throws Error naming the field.
  void check() const;
};

/// What one picture shows of a board. ChArUco boards may be seen in part; the others are whole or
/// not found.
struct BoardView {
  std::string name;                     ///< file or number of the picture
  int image_width = 0;                  ///< [px]
  int image_height = 0;                 ///< [px]
  std::vector<int> ids;                 ///< of the points found, ascending [1]
  std::vector<Eigen::Vector2d> pixels;  ///< one per id, distorted as the camera saw them [px]
  std::string failure;                  ///< why the board was not found, empty when it was
  double sharpness = 0;                 ///< 10 % to 90 % width of the edges at the points [px]
  double clipped_share = 0;             ///< of the board's pixels at 255 [0..1]

  bool found() const { return failure.empty() && !ids.empty(); }
};

/// Looks for the board. Sub-pixel. When it is not there, failure says in one clause what was seen
/// instead (nothing like a board, 4 x 6 points instead of 9 x 6, mirrored, blurred by so many
/// pixels, clipped) and what to do. Throws Error only on an empty picture or an impossible board.
BoardView find_board(ImageView8 image, const Board& board, const std::string& name);

/// "chessboard", "circles", "asymmetric-circles" or "charuco".
BoardKind board_kind_from_name(const std::string& name);
std::string to_string(BoardKind kind);

}  // namespace facula
