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
  Eigen::Matrix<double, 6, 6> information = Eigen::Matrix<double, 6, 6>::Identity();
};

struct PoseGraphOptions {
  std::size_t anchor = 0;      ///< scan whose pose is the world
  double outlier_chi2 = 22.5;  ///< an edge beyond is an outlier; 22.5 = 99.9 % of chi2, 6 dof [1]
  bool robust = true;          ///< wrong edges lose their weight
  int max_iterations = 200;    ///< [1]

  void check() const;
};

struct EdgeResidual {
  double translation = 0;  ///< [m]
  double rotation = 0;     ///< [rad]
  double chi2 = 0;         ///< squared residual by the edge's information [1]
  double weight = 1;       ///< 0 = given up [0..1]
  bool outlier = false;
};

struct PoseGraphResult {
  std::vector<RigidTransform> world_from_scan;          ///< of every scan connected to the anchor
  std::vector<bool> connected;                          ///< by edges that are no outliers
  std::vector<Eigen::Matrix<double, 6, 6>> covariance;  ///< of each pose against the anchor's
  std::vector<EdgeResidual> edges;                      ///< in the order given
  double chi2 = 0;                                      ///< over the edges kept [1]
  int degrees_of_freedom = 0;                           ///< of that chi2 [1]
};

/// Poses that fit all edges best, in the least-squares sense on SE(3) (Ceres), with robust loops.
PoseGraphResult solve_pose_graph(std::size_t scans,
                                 const std::vector<PoseEdge>& edges,
                                 const std::vector<RigidTransform>& world_from_scan_guess,
                                 const PoseGraphOptions& options = {});

}  // namespace facula
