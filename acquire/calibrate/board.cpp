// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/calibrate/board.hpp>
#include <facula/acquire/core/error.hpp>

#include <array>
#include <cmath>
#include <numbers>

namespace facula {
namespace {

constexpr std::array kKinds = {BoardKind::kChessboard,
                               BoardKind::kCircles,
                               BoardKind::kAsymmetricCircles,
                               BoardKind::kCharuco};

}  // namespace

Eigen::Vector3d Board::point(int id) const {
  const int row = id / cols;
  const int col = id % cols;
  if (kind == BoardKind::kAsymmetricCircles) {
    return {(2 * col + row % 2) * spacing, row * spacing, 0};
  }
  return {col * spacing, row * spacing, 0};
}

double Board::pitch() const {
  return kind == BoardKind::kAsymmetricCircles ? std::numbers::sqrt2 * spacing : spacing;
}

std::array<Eigen::Vector3d, 4> Board::outline(double margin) const {
  const double beyond = margin * pitch();
  const bool asymmetric = kind == BoardKind::kAsymmetricCircles;
  const double right = (asymmetric ? 2 * cols - 1 : cols - 1) * spacing + beyond;
  const double bottom = (rows - 1) * spacing + beyond;
  return {Eigen::Vector3d(-beyond, -beyond, 0),
          Eigen::Vector3d(right, -beyond, 0),
          Eigen::Vector3d(right, bottom, 0),
          Eigen::Vector3d(-beyond, bottom, 0)};
}

void Board::check() const {
  require(cols >= 2 && rows >= 2 && cols <= 100 && rows <= 100 && size() >= 6,
          "board: expected 2 to 100 columns and rows and 6 points or more, got ",
          cols,
          " x ",
          rows);
  require(std::isfinite(spacing) && spacing > 1e-5 && spacing < 10,
          "board spacing_mm: expected 0.01 to 10000, got ",
          1000 * spacing);
  require(std::isfinite(circle_diameter) && circle_diameter >= 0 && circle_diameter < pitch(),
          "board circle_diameter_mm: expected less than the distance of the circles (",
          1000 * pitch(),
          " mm), got ",
          1000 * circle_diameter);
  require(std::isfinite(marker_size) && marker_size >= 0 && marker_size < spacing,
          "board marker_mm: expected less than the squares' side of ",
          1000 * spacing,
          " mm, got ",
          1000 * marker_size);
}

BoardKind board_kind_from_name(const std::string& name) {
  for (const BoardKind kind : kKinds) {
    if (to_string(kind) == name) return kind;
  }
  fail("expected a board chessboard, circles, asymmetric-circles or charuco, got '", name, "'");
}

std::string to_string(BoardKind kind) {
  switch (kind) {
    case BoardKind::kChessboard:
      return "chessboard";
    case BoardKind::kCircles:
      return "circles";
    case BoardKind::kAsymmetricCircles:
      return "asymmetric-circles";
    case BoardKind::kCharuco:
      return "charuco";
  }
  return "chessboard";
}

}  // namespace facula
