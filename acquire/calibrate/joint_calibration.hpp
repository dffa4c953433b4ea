// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/calibrate/board.hpp>
#include <facula/acquire/calibrate/laser_calibration.hpp>
#include <facula/acquire/core/rigid_transform.hpp>
#include <facula/acquire/rig/rig.hpp>

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace facula {

/// One picture: what it shows of a board, the laser lines on it, and where the axis stood.
struct JointView {
  std::size_t board = 0;           ///< which of the set's boards [1]
  std::optional<double> position;  ///< of the axis [rad or m]; none: held by hand, its pose is free
  std::size_t placement = 0;  ///< of a view with a position: equal where the board was not touched
                              ///< between; such views share one pose, moved by the axis [1]
  BoardView points;
  std::vector<LaserLineView> lines;  ///< on this board; their `view` counts for nothing
};

/// All pictures of a calibration. The first board is the one whose size is believed.
struct CalibrationSet {
  std::vector<Board> boards;
  std::vector<JointView> views;
  std::vector<std::string> lasers;  ///< names of the sheets; none: only camera and axis
  AxisKind axis = AxisKind::kNone;
  StripeDirection stripe_direction = StripeDirection::kPerRow;
};

struct JointOptions {
  std::optional<Camera> camera;  ///< start, or the truth with fix_camera; none: from the boards
  bool fix_camera = false;       ///< take `camera` as exact
  bool tangential = true;        ///< estimate p1, p2
  int radial_terms = 2;          ///< how many of k1, k2, k3 are estimated, 0 to 3 [1]
  bool bow = false;              ///< estimate the opening of each sheet's cone
  double point_sigma = 0;  ///< of a board point along x and y, 0 = estimated from the fit [px]
  double line_sigma_ratio =
      0;                      ///< what the lines scatter over what their sigmas say, 0 = estimated
  double position_sigma = 0;  ///< of the axis positions, 0 = exact [rad or m]
  double outlier_sigmas = 5;  ///< observations farther off are left out of the fit [1]
  int folds = 5;              ///< parts of the views held out in turn, 0 = none [1]
  int num_threads = 0;        ///< 0 = all cores [1]
  void check() const;
};

/// How one view fits. Every figure is over all points, wrong ones included.
struct JointViewResidual {
  std::string name;
  std::size_t points = 0;             ///< of the board [1]
  std::size_t wrong_points = 0;       ///< left out of the fit [1]
  std::size_t line_points = 0;        ///< [1]
  std::size_t wrong_line_points = 0;  ///< [1]
  double point_rms = 0;               ///< distance [px]
  double line_rms = 0;                ///< across the line [px]
  double held_out_point_rms = 0;      ///< distance, the rig from the other views [px]
  double held_out_line_rms = 0;       ///< [px]
  double held_out_line_rms_mm = 0;    ///< off the sheet [mm]
  double held_out_line_mean_mm = 0;   ///< the same with sign [mm]
};

/// Size of a board as the measurement finds it, over the size it is said to have.
struct BoardScale {
  std::size_t board = 0;
  bool decided = false;   ///< whether lines or the axis tie this board to the first
  double factor = 1;      ///< [1]
  double sigma = 0;       ///< [1]
  bool conflict = false;  ///< off 1 by more than 3 sigma: the sizes said of the boards contradict
};

/// RMS over all points of all views.
struct JointFigures {
  double point_rms = 0;     ///< of the board points [px]
  double point_median = 0;  ///< middle distance, which wrong points cannot spoil [px]
  double line_rms = 0;      ///< of the lines [px]
  double line_rms_mm = 0;   ///< of the lines off the sheet [mm]
};

struct JointCalibration {
  Rig rig;                                        ///< with its covariance
  std::vector<RigidTransform> camera_from_board;  ///< per view of the set; rejected: the identity
  std::vector<double> positions;                  ///< per view of the set, as estimated [rad or m]
  std::vector<JointViewResidual> views;           ///< of those used
  JointFigures fit;                               ///< each view took part in the fit
  std::optional<JointFigures> held_out;           ///< each view from the fit without it
  double point_sigma = 0;          ///< of a board point along x and y, given or estimated [px]
  double line_sigma_ratio = 1;     ///< given or estimated [1]
  double reduced_chi_squared = 0;  ///< of what took part, with the sigmas above [1]
  double fold_scatter = 0;  ///< sigma of the parameters by the folds (jackknife) over the sigma by
                            ///< the residuals, in the mean [1]; 0 without folds
  std::size_t points = 0;   ///< board points [1]
  std::size_t wrong_points = 0;       ///< of them left out of the fit [1]
  std::size_t line_points = 0;        ///< [1]
  std::size_t wrong_line_points = 0;  ///< of them left out of the fit [1]
  std::vector<BoardScale> scales;     ///< of the second board on
  std::vector<std::string> rejected;  ///< one clause per view left out: which and why
  std::vector<std::string> warnings;  ///< what the views cannot decide or contradict, what to do
};

/// One robust least squares over camera, distortion, all sheets, axis and board poses: board points
/// against their projections, line pixels against where the sheet cuts the board. Gross errors are
/// found by a robust fit and left out of the last one, never out of the figures. The covariance is
/// that of the last fit, raised where the folds scatter twice as much as it says. A second board
/// gets a scale of its own where it contradicts the first one's size; that is said, and neither is
/// averaged away. Throws Error, saying which, when the views cannot determine what is asked.
JointCalibration calibrate_jointly(const CalibrationSet& set, const JointOptions& options = {});

}  // namespace facula
