// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/calibrate/board_pattern.hpp>

#include <algorithm>
#include <cmath>

namespace facula {
namespace {

/// Share of [low, high] within the interval of length `width` about x, over width.
double overlap(double x, double width, double low, double high) {
  const double from = std::max(low, x - width / 2);
  const double to = std::min(high, x + width / 2);
  return std::max(0.0, to - from) / width;
}

/// Mean over the interval of the square wave that is +1 on [0, 1), -1 on [1, 2) and so on: the
/// difference of its integral, a triangle wave.
double mean_square_wave(double x, double width) {
  const auto integral = [](double t) {
    const double phase = t - 2 * std::floor(t / 2);
    return phase < 1 ? phase : 2 - phase;
  };
  return (integral(x + width / 2) - integral(x - width / 2)) / width;
}

}  // namespace

BoardPattern::BoardPattern(const Board& board, double quiet_zone)
    : board_(board),
      radius_(board.circle_diameter > 0 ? board.circle_diameter / 2 : board.spacing / 4) {
  board.check();
  const bool squares = board.kind == BoardKind::kChessboard || board.kind == BoardKind::kCharuco;
  const auto corners = board.outline(quiet_zone + (squares ? 1 : 0.5));
  low_ = corners[0].head<2>();
  high_ = corners[2].head<2>();
  if (board.kind == BoardKind::kCharuco) markers_ = charuco_markers(board);
}

bool BoardPattern::covers(const Eigen::Vector2d& place) const {
  return (place.array() >= low_.array()).all() && (place.array() <= high_.array()).all();
}

double BoardPattern::white(const Eigen::Vector2d& place, double width) const {
  if (!covers(place)) return 0;
  const bool squares_kind =
      board_.kind == BoardKind::kChessboard || board_.kind == BoardKind::kCharuco;
  return squares_kind ? squares(place, width) : circles(place, width);
}

double BoardPattern::squares(const Eigen::Vector2d& place, double width) const {
  // The squares begin one pitch before point 0 and the first is black.
  const Eigen::Vector2d at = place / board_.spacing + Eigen::Vector2d::Ones();
  const double w = width / board_.spacing;
  const double inside =
      overlap(at.x(), w, 0, board_.cols + 1) * overlap(at.y(), w, 0, board_.rows + 1);
  double white = 0.5 - 0.5 * mean_square_wave(at.x(), w) * mean_square_wave(at.y(), w);
  const int col = static_cast<int>(std::floor(at.x()));
  const int row = static_cast<int>(std::floor(at.y()));
  const bool on_board = col >= 0 && row >= 0 && col <= board_.cols && row <= board_.rows;
  if (!markers_.empty() && on_board && (col + row) % 2 == 1) {
    int index = col / 2;
    for (int r = 0; r < row; ++r) index += (board_.cols + 1 + r % 2) / 2;
    const Eigen::Vector2d centre(col + 0.5, row + 0.5);
    const double side = board_.marker_side() / board_.spacing;
    white -= marker(index, (at - centre) / side + Eigen::Vector2d(0.5, 0.5), w / side);
  }
  return inside * white + (1 - inside);
}

/// How much black the marker adds; `place` in units of its side from its upper left.
double BoardPattern::marker(int index, const Eigen::Vector2d& place, double width) const {
  const MarkerBits& bits = markers_[static_cast<std::size_t>(index)];
  const int cells = bits.side + 2;
  double black = overlap(place.x(), width, 0, 1) * overlap(place.y(), width, 0, 1);
  if (black == 0) return 0;
  for (int r = 0; r < bits.side; ++r) {
    for (int c = 0; c < bits.side; ++c) {
      if (bits.bits[static_cast<std::size_t>(r * bits.side + c)] == 0) continue;
      const double left = static_cast<double>(c + 1) / cells;
      const double top = static_cast<double>(r + 1) / cells;
      black -= overlap(place.x(), width, left, left + 1.0 / cells) *
               overlap(place.y(), width, top, top + 1.0 / cells);
    }
  }
  return black;
}

double BoardPattern::circles(const Eigen::Vector2d& place, double width) const {
  const bool asymmetric = board_.kind == BoardKind::kAsymmetricCircles;
  const int row =
      std::clamp(static_cast<int>(std::lround(place.y() / board_.spacing)), 0, board_.rows - 1);
  double black = 0;
  for (int r = std::max(0, row - 1); r <= std::min(board_.rows - 1, row + 1); ++r) {
    const double step = asymmetric ? 2 * board_.spacing : board_.spacing;
    const double shift = asymmetric && r % 2 == 1 ? board_.spacing : 0;
    const int col =
        std::clamp(static_cast<int>(std::lround((place.x() - shift) / step)), 0, board_.cols - 1);
    const double from_edge =
        radius_ - (place - board_.point(r * board_.cols + col).head<2>()).norm();
    black = std::max(black, std::clamp(from_edge / width + 0.5, 0.0, 1.0));
  }
  return 1 - black;
}

}  // namespace facula
