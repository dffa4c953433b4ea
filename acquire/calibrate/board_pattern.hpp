// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/calibrate/board.hpp>

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace facula {

/// The black squares of a marker, row by row from its upper left, its black border left out.
struct MarkerBits {
  int side = 0;                    ///< bits in a row [1]
  std::vector<std::uint8_t> bits;  ///< 1 = white
};

/// The markers of a ChArUco board in the order of its white squares, row by row. Throws Error on an
/// unknown dictionary or one with fewer markers than the board has white squares.
std::vector<MarkerBits> charuco_markers(const Board& board);

/// What is printed on a board, as a function of the place.
class BoardPattern {
 public:
  /// `quiet_zone` is the white border beyond the outer squares or circles [pitches].
  explicit BoardPattern(const Board& board, double quiet_zone = 0.5);

  /// Share of white in the square of side `width` [m] about a place of the board's frame [m]:
  /// exact for what is printed square to the axes, to about 1 % of the width for circles. Beyond
  /// the sheet of paper it is 0 with covers() false.
  double white(const Eigen::Vector2d& place, double width) const;
  bool covers(const Eigen::Vector2d& place) const;

 private:
  double squares(const Eigen::Vector2d& place, double width) const;
  double circles(const Eigen::Vector2d& place, double width) const;
  double marker(int index, const Eigen::Vector2d& place, double width) const;

  Board board_;
  double radius_;  ///< of the circles [m]
  Eigen::Vector2d low_;
  Eigen::Vector2d high_;
  std::vector<MarkerBits> markers_;
};

}  // namespace facula
