// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/calibrate/laser_calibration.hpp>

#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Core>

namespace facula {

/// A point of the line and what moves it.
struct SheetPoint {
  Eigen::Vector3d x;          ///< camera frame [m]
  Eigen::Vector3d per_pixel;  ///< how it moves when the pixel moves across the line [m/px]
  Eigen::Matrix3d per_pose;   ///< by a turn about the board's x, y and a shift along its normal
  double sigma = 0;           ///< of the pixel [px]
};

/// The points of one view.
struct SheetView {
  std::size_t view = 0;  ///< as in LaserLineView [1]
  Eigen::Matrix3d pose_covariance;
  std::vector<SheetPoint> points;
};

/// Where the ray of a pixel meets the board; none when it misses it.
std::optional<Eigen::Vector3d> meet_board(const Camera& camera,
                                          const RigidTransform& camera_from_board,
                                          const Eigen::Vector2d& pixel);

/// The lines of one laser as points in space.
std::vector<SheetView> sheet_views(const Camera& camera,
                                   const std::vector<BoardPose>& poses,
                                   const std::vector<LaserLineView>& lines,
                                   std::size_t laser,
                                   double least_sigma);

/// The plane through points, least squares, and how far they reach square to their main direction.
struct PlaneStart {
  LaserPlane plane;
  double breadth = 0;  ///< standard deviation along the second direction [m]
  double length = 0;   ///< along the first [m]
};
PlaneStart plane_through(const std::vector<SheetView>& views);

struct SheetFit {
  LaserPlane plane;
  Eigen::MatrixXd covariance;  ///< of turn a, turn b [rad], distance [m], bow [rad]
  double variance_factor = 1;  ///< of the points against their sigmas, robust [1]
  double outlier_share = 0;    ///< [0..1]
};

/// Weighed, robust least squares; the points of one board share its error.
SheetFit fit_sheet(const std::vector<SheetView>& views, const LaserCalibrationOptions& options);

}  // namespace facula
