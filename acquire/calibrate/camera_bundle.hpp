// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/calibrate/board.hpp>
#include <facula/acquire/core/rigid_transform.hpp>
#include <facula/acquire/rig/camera.hpp>

#include <optional>
#include <vector>

#include <Eigen/Core>

namespace facula {

/// A camera and the boards before it.
struct CameraBundle {
  Camera camera;
  std::vector<RigidTransform> poses;  ///< camera_from_board per view [m]
};

struct BundleOptions {
  bool fixed_camera = false;   ///< estimate poses only
  bool tangential = true;      ///< p1, p2
  int radial_terms = 3;        ///< how many of k1, k2, k3, 0 to 3 [1]
  bool square_pixels = false;  ///< fx = fy
};

struct BundleResult {
  CameraBundle bundle;
  double variance = 0;      ///< of a pixel coordinate: squares over degrees of freedom [px^2]
  std::vector<double> rms;  ///< of the point distances, per view [px]
  Eigen::MatrixXd camera_covariance;  ///< of fx fy cx cy k1 k2 p1 p2 k3, 0 where not estimated
  /// Per view, of a turn [rad] and a shift [m] in board axes; with the camera held exact.
  std::vector<Eigen::Matrix<double, 6, 6>> pose_covariance;
};

/// Where the camera sees point `on_board`. Of a circle of diameter d its image's centre, which is
/// not the image of its centre: the pole of the line at infinity to the dual of the circle's conic
/// (Hartley and Zisserman 2004, 2.2.3 and 8.3), that is the image of
/// X - (d^2 / 4 Z) (r1 r31 + r2 r32).
Eigen::Vector2d seen_at(const CameraBundle& bundle,
                        std::size_t view,
                        const Eigen::Vector3d& on_board,
                        double circle_diameter);

/// Least squares over all points of all views, from `start`. None when it does not converge or the
/// views leave a parameter undetermined.
std::optional<BundleResult> fit_bundle(const Board& board,
                                       const std::vector<BoardView>& views,
                                       const CameraBundle& start,
                                       const BundleOptions& options);

/// Zhang's closed form (2000) with the principal point in the middle and no distortion, and poses
/// that go with it. A focal length that cannot be is replaced by 1.2 image widths.
CameraBundle start_bundle(const Board& board, const std::vector<BoardView>& views);

/// A pose that most points of the view agree with to `inlier_distance` [px], and the view with only
/// those points; none when fewer than 4 agree.
struct LocatedBoard {
  RigidTransform camera_from_board;  ///< [m]
  BoardView inliers;
};
std::optional<LocatedBoard> locate_robustly(const Board& board,
                                            const BoardView& view,
                                            const Camera& camera,
                                            double inlier_distance);

}  // namespace facula
