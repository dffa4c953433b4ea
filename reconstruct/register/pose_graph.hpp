// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/rigid_transform.hpp>

#include <cstddef>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace facula {

/// A measured pose of one scan relative to another.
struct PoseEdge {
  std::size_t from = 0;         ///< index of the source scan
  std::size_t to = 0;           ///< index of the target scan
  RigidTransform to_from_from;  ///< target_from_source

  /// Of the twist e = (translation [m], rotation [rad]) in true pose = exp_se3(e) * to_from_from.
  /// May be of low rank: what it leaves open, the edge does not measure.
  Eigen::Matrix<double, 6, 6> information = Eigen::Matrix<double, 6, 6>::Identity();
};

struct PoseGraphOptions {
  std::size_t anchor = 0;      ///< scan whose pose is the world
  double outlier_chi2 = 22.5;  ///< an edge beyond is an outlier; 22.5 = 99.9 % of chi2, 6 dof [1]
  bool robust = true;          ///< wrong edges lose their weight
  int max_iterations = 200;    ///< of each least squares [1], at least 1

  void check() const;
};

struct EdgeResidual {
  double translation = 0;  ///< [m]
  double rotation = 0;     ///< [rad]
  double chi2 = 0;         ///< squared residual by the edge's information [1]
  double redundancy = 0;   ///< share of the edge that the others check; 0 = none can [0..1]
  bool outlier = false;
};

struct PoseGraphResult {
  std::vector<RigidTransform> world_from_scan;
  std::vector<std::size_t> component;  ///< lowest scan reached over edges that are no outliers
  std::vector<bool> connected;         ///< to the anchor, by such edges

  /// Of the twist e in true pose = exp_se3(e) * world_from_scan, against the pose that stays: the
  /// anchor's, and in other components that of the lowest scan. Huge where edges leave it open.
  std::vector<Eigen::Matrix<double, 6, 6>> covariance;
  Eigen::MatrixXd joint_covariance;  ///< of all poses together, six rows and columns per scan
  std::vector<EdgeResidual> edges;   ///< in the order given
  double chi2 = 0;                   ///< over the edges kept [1]
  int degrees_of_freedom = 0;        ///< of that chi2 [1]
};

/// Poses that fit all edges best, in the least-squares sense on SE(3) (Ceres). When robust, wrong
/// edges are found by graduated non-convexity (Yang et al. 2020) and given up; the poses are then
/// the plain least squares over the edges kept. Each component keeps the guessed pose of one scan.
/// Throws Error when an edge names a scan that is not there, joins a scan with itself, or holds an
/// information that is no covariance's inverse.
PoseGraphResult solve_pose_graph(std::size_t scans,
                                 const std::vector<PoseEdge>& edges,
                                 const std::vector<RigidTransform>& world_from_scan_guess,
                                 const PoseGraphOptions& options = {});

}  // namespace facula
