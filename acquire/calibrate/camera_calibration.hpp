// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/calibrate/board.hpp>
#include <facula/acquire/core/rigid_transform.hpp>
#include <facula/acquire/rig/camera.hpp>

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace facula {

struct CameraCalibrationOptions {
  bool tangential = true;      ///< estimate p1, p2
  int radial_terms = 3;        ///< how many of k1, k2, k3 are estimated, 0 to 3 [1]
  bool square_pixels = false;  ///< fx = fy
  double max_view_rms = 0;  ///< drop views worse than this and say so, 0 = 3 times the median [px]
  void check() const;
};

/// How one view fits.
struct CalibratedView {
  std::size_t view = 0;              ///< index into the views given [1]
  RigidTransform camera_from_board;  ///< [m]
  double rms = 0;                    ///< of the point distances [px]
  double held_out_rms = 0;           ///< of the same view when intrinsics come from the others [px]
  double tilt = 0;                   ///< between the board's normal and the camera's axis [rad]
  std::size_t points = 0;            ///< used [1]
  /// Of a small turn [rad], then a small shift [m] of the board, along its own axes at its origin,
  /// the camera taken as exact: camera_from_board * exp(...).
  Eigen::Matrix<double, 6, 6> pose_covariance = Eigen::Matrix<double, 6, 6>::Zero();
};

struct CameraCalibration {
  Camera camera;
  Eigen::MatrixXd covariance;  ///< of fx fy cx cy k1 k2 p1 p2 k3 [px, 1]; 0 where not estimated
  std::vector<CalibratedView> views;  ///< those used
  std::vector<std::string> rejected;  ///< one clause per view left out: which and why
  std::vector<std::string> warnings;  ///< what these views cannot decide, and what to add
  double rms = 0;                     ///< over all points used [px]
  double held_out_rms = 0;            ///< over all points, each from the fit without its view [px]
  std::size_t points = 0;             ///< [1]
};

/// Zhang's calibration (2000) from views of a flat board, by least squares over all points. Throws
/// Error, saying which, when the views cannot determine a camera: fewer than 3 found, all parallel
/// to each other, of different sizes.
CameraCalibration calibrate_camera(const Board& board,
                                   const std::vector<BoardView>& views,
                                   const CameraCalibrationOptions& options = {});

/// Pose of the board from one view with a known camera, points weighed alike, outliers left out
/// (reprojection above `inlier_distance` [px]). Throws Error when fewer than 4 points agree.
CalibratedView locate_board(const Board& board,
                            const BoardView& view,
                            const Camera& camera,
                            double inlier_distance = 3);

}  // namespace facula
