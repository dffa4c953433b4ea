// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/calibrate/joint_calibration.hpp>

#include <cstdint>

namespace facula {

/// What a rig would see of boards held by hand and boards moved by its axis.
struct SyntheticSetOptions {
  double distance = 0.3;      ///< between camera and boards, about [m]
  double axis_distance = 0;   ///< the same of the boards put up for the axis, 0 = distance [m]
  double board_share = 0.53;  ///< width of a board over `distance` [1]
  int hand_views = 12;        ///< boards held by hand, tilted by 26 to 52 degrees [1]
  int placements = 3;         ///< boards put up for the axis [1]
  int positions = 7;          ///< of the axis per placement [1]
  double span = 1.0;          ///< of the axis positions [rad, of a linear axis m]
  double axis_tilt = 0.5;     ///< of the boards put up for the axis, at most [rad]
  double point_noise = 0.1;   ///< of a board point along x and y, standard deviation [px]
  double line_noise = 0.1;    ///< of a line pixel along the row or column [px]
  int line_points = 60;       ///< per line and view [1]
  int board_cols = 9;         ///< points in a row [1]
  int board_rows = 6;         ///< [1]
  int boards = 1;             ///< 2: the placements show the second board [1]
  double second_scale = 1;    ///< true size of the second board over what the set says [1]
  double wrong_share = 0;     ///< of the board points moved by up to 20 px [0..1]
  std::uint64_t seed = 1;
  void check() const;
};

/// A calibration set by projection, without pictures: board points and lines with normal noise. The
/// boards hold 9 x 6 points, 0.066 distances apart, unless told. A view may show a part of the
/// board, half of its points or more. The rig is not told to the set, but the kind of its axis, the
/// names of its lasers and the axis positions are.
CalibrationSet synthesize_calibration_set(const Rig& rig, const SyntheticSetOptions& options = {});

}  // namespace facula
