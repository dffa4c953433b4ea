// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/calibrate/board.hpp>
#include <facula/acquire/core/image_view.hpp>
#include <facula/acquire/core/rigid_transform.hpp>
#include <facula/acquire/rig/camera.hpp>
#include <facula/acquire/rig/laser_plane.hpp>
#include <facula/acquire/stripe/stripe_detector.hpp>

#include <cstddef>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace facula {

/// One laser line where one picture shows it on a board.
struct LaserLineView {
  std::size_t view = 0;   ///< which picture, as the poses count them [1]
  std::size_t laser = 0;  ///< which sheet of the rig [1]
  StripeDirection direction = StripeDirection::kPerRow;  ///< how the line was searched
  std::vector<Eigen::Vector2d> pixels;                   ///< distorted as the camera saw them [px]
  std::vector<double> sigmas;  ///< of x (per row) or y (per column), 1 standard deviation [px]
  std::string failure;         ///< why no line was found, empty when it was
};

struct BoardLineOptions {
  StripeOptions stripe;
  double margin = 0.4;  ///< how far beyond the outer points the board is searched [spacings]
  double max_jump = 6;  ///< farthest from the straight line that most of it lies on [px]
  void check() const;
};

/// The stripe on the board: `frame` is searched within the outline of the board only, so that
/// reflections and what else is lit count for nothing. `background`, when not empty, is the same
/// view without the laser. A line that is found in fewer than 20 places has a failure instead.
LaserLineView find_line_on_board(ImageView8 frame,
                                 ImageView8 background,
                                 const Board& board,
                                 const Camera& camera,
                                 const RigidTransform& camera_from_board,
                                 const BoardLineOptions& options = {});

/// The board of a view and how well its place is known.
struct BoardPose {
  RigidTransform camera_from_board;  ///< [m]
  /// Of turns about the board's x and y [rad] and a shift along its normal [m], all at the board's
  /// origin, in board axes. These three move the points of a laser line; the others do not.
  Eigen::Matrix3d plane_covariance = Eigen::Matrix3d::Zero();
};

struct LaserCalibrationOptions {
  bool bow = false;               ///< also estimate the opening of the sheet's cone
  double outlier_sigmas = 4;      ///< points farther off weigh less and less (Tukey, 1974) [1]
  double min_pixel_sigma = 0.02;  ///< added to each sigma in square: what no detector knows [px]
  void check() const;
};

/// How one view's line fits.
struct LaserViewResidual {
  std::size_t view = 0;      ///< as in LaserLineView [1]
  std::size_t points = 0;    ///< [1]
  double rms = 0;            ///< off the sheet fitted to all views, over all its points [m]
  double mean = 0;           ///< the same with sign [m]
  double held_out_rms = 0;   ///< off the sheet fitted to the other views, over all its points [m]
  double held_out_mean = 0;  ///< [m]
};

struct LaserCalibration {
  LaserPlane plane;
  /// Of the tilts of the normal along tangent_basis(normal) [rad], the distance [mm] and the bow
  /// [rad]: 3 x 3, or 4 x 4 with a bow. The camera is taken as exact.
  Eigen::MatrixXd covariance;
  std::vector<LaserViewResidual> views;
  std::vector<std::string> warnings;  ///< what these views cannot decide, and what to add
  double rms = 0;                     ///< over all points of all views [m]
  double held_out_rms = 0;            ///< over all points, each from the fit without its view [m]
  double outlier_share = 0;           ///< of points beyond outlier_sigmas [0..1]
  double reduced_chi_squared = 0;     ///< of the points against their sigmas [1]
  std::size_t points = 0;             ///< [1]
};

/// Sheet of light from lines on boards whose poses are known: each pixel's ray meets its board, and
/// the sheet is fitted to these points, weighed by what pixel noise and the pose of the board leave
/// uncertain; the points of one board share its error. Lines of other sheets than `laser` are left
/// aside. `poses` are counted as LaserLineView::view. Throws Error when fewer than 2 views hold the
/// line or all points lie on one line in space.
LaserCalibration calibrate_laser(const Camera& camera,
                                 const std::vector<BoardPose>& poses,
                                 const std::vector<LaserLineView>& lines,
                                 std::size_t laser = 0,
                                 const LaserCalibrationOptions& options = {});

/// Points of a line in the camera frame: each pixel's ray meets the board [m]. A ray that misses it
/// gives NaN.
std::vector<Eigen::Vector3d> points_on_board(const Camera& camera,
                                             const RigidTransform& camera_from_board,
                                             const LaserLineView& line);

}  // namespace facula
