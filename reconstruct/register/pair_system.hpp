// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/reconstruct/register/point_pairs.hpp>
#include <facula/reconstruct/register/robust_weight.hpp>
#include <facula/reconstruct/register/twist.hpp>

#include <vector>

#include <Eigen/Core>

namespace facula {

/// The normal equations of all pairs, for a twist about `pivot` in target coordinates.
struct PairSystem {
  Eigen::Vector3d pivot = Eigen::Vector3d::Zero();  ///< centroid of the paired points [m]
  double radius = 1;                                ///< their rms distance from it [m]
  double scale = 1;                                 ///< robust standard deviation of residuals [1]
  Matrix6 hessian = Matrix6::Zero();
  Vector6 gradient = Vector6::Zero();

  /// What the surfaces themselves say about a motion (m, rad * radius): 1 where all normals oppose
  /// it, 0 where none does. From products of source normal and target normal, whose errors are
  /// independent, so that the noise of normals does not pass for shape.
  Matrix6 shape = Matrix6::Zero();
};

PairSystem assemble(const std::vector<PointPair>& pairs, const PairOptions& options);

}  // namespace facula
