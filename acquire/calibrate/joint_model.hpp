// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/calibrate/joint_calibration.hpp>

#include <cstddef>
#include <vector>

#include <Eigen/Core>

namespace facula {

/// Everything the joint calibration estimates.
struct JointState {
  Rig rig;
  std::vector<double> scales;         ///< per board of the set, the first 1 [1]
  std::vector<double> positions;      ///< per view used [rad or m]
  std::vector<RigidTransform> poses;  ///< camera_from_board of hand-held views, scan_from_board of
                                      ///< placements
};

/// One board point: where it is on the board, where it was seen.
struct JointPoint {
  Eigen::Vector3d on_board;  ///< as the board's size is said to be [m]
  Eigen::Vector2d pixel;     ///< [px]
  bool wrong = false;        ///< left out of the fit
};

/// One pixel of a laser line.
struct JointLinePoint {
  std::size_t laser = 0;
  Eigen::Vector2d pixel;                              ///< [px]
  double sigma = 0;                                   ///< across the line, along `across` [px]
  Eigen::Vector2d across = Eigen::Vector2d::UnitX();  ///< direction in which the pixel is uncertain
  bool wrong = false;
};

/// A view that takes part.
struct JointSight {
  std::size_t view = 0;   ///< index into the set
  std::size_t board = 0;  ///< [1]
  std::size_t pose = 0;   ///< index into JointState::poses
  bool placed = false;    ///< the pose is scan_from_board and the axis moves it
  double position = 0;    ///< as read from the axis [rad or m]
  std::vector<JointPoint> points;
  std::vector<JointLinePoint> lines;
};

/// The standard deviations by which residuals are weighed.
struct JointNoise {
  double point_sigma = 0.1;   ///< [px]
  double line_ratio = 1;      ///< times JointLinePoint::sigma [1]
  double position_sigma = 0;  ///< 0 = exact [rad or m]
};

/// What is estimated, from which sights.
struct JointFreedom {
  std::vector<std::string> rig_parameters;  ///< of the rig; all others are held
  std::vector<bool> scales;                 ///< per board
  std::vector<bool> poses;                  ///< per pose
  std::vector<bool> sights;                 ///< which take part
  bool lines = true;                        ///< whether the laser lines take part
  double robust_scale = 0;  ///< Cauchy's weights beyond so many sigmas, 0 = least squares [1]
};

/// camera_from_board of a sight.
RigidTransform camera_from_board(const JointState& state, const JointSight& sight, std::size_t i);

/// Reprojection error of board point p of sight i [px]; NaN when it lies behind the camera.
Eigen::Vector2d point_residual(const JointState& state,
                               const std::vector<JointSight>& sights,
                               std::size_t i,
                               std::size_t p);

/// How far the ray of line point p of sight i meets the board off the sheet [m], and the same
/// across the line [px]; NaN when the ray misses the board.
struct LineResidual {
  double metres = 0;
  double slope = 0;  ///< metres per pixel, above 0
  double pixels() const { return metres / slope; }
};
LineResidual line_residual(const JointState& state,
                           const std::vector<JointSight>& sights,
                           std::size_t i,
                           std::size_t p);

}  // namespace facula
