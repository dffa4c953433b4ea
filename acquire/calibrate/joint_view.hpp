// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/calibrate/joint_model.hpp>

#include <Eigen/Core>

/// What all points of a view, and all lines of a sheet, share in a residual: computed once per step
/// of the solver with its derivatives, so that a point costs a few products only.
namespace facula {

/// Where a board stands before the camera: camera_from_board as three columns of the rotation and
/// the translation.
struct JointViewPose {
  Eigen::Matrix<double, 3, 4> at;
  /// The entries of `at`, column by column, by 6 numbers of the pose, 4 of the axis, the position.
  Eigen::Matrix<double, 12, 11> by;
};

/// The changes from the state at the start, in the order of rig_parameters.hpp, lengths in metres.
struct JointViewChange {
  const double* pose;      ///< 6: shift and turn in the board's frame
  const double* axis;      ///< 4; read of placed views only
  const double* position;  ///< 1; likewise
};

JointViewPose joint_view_pose(const JointState& state,
                              const std::vector<JointSight>& sights,
                              std::size_t i,
                              const JointViewChange& change);

/// Normal and distance of a flat sheet.
struct JointSheet {
  Eigen::Vector4d at;  ///< normal [1], distance [m]
  Eigen::Matrix4d by;  ///< of `at` by the sheet's 4 numbers
};
JointSheet joint_sheet(const LaserPlane& plane, const double* change);

/// A pixel with its derivatives.
struct JointPixel {
  Eigen::Vector2d at;                     ///< [px]
  Eigen::Matrix2d by_normalized;          ///< by the point of the plane z = 1
  Eigen::Matrix<double, 2, 9> by_camera;  ///< by fx fy cx cy k1 k2 p1 p2 k3
};
JointPixel joint_pixel(const Camera& camera,
                       const double* change,
                       const Eigen::Vector2d& normalized);

}  // namespace facula
