// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/rigid_transform.hpp>

#include <array>

#include <Eigen/Core>

namespace ceres {
class CostFunction;
}

namespace facula {

/// A pose changed by (translation [m], rotation vector [rad]) on its left, the rotation about the
/// world's origin. To first order this is exp_se3(change) * pose.
RigidTransform moved(const RigidTransform& pose, const std::array<double, 6>& change);

/// How far an edge is from the poses it joins, as a function of the changes of both:
/// root * log_se3(to^-1 from to_from_from^-1). The caller owns it.
ceres::CostFunction* pose_edge_cost(const RigidTransform& from,
                                    const RigidTransform& to,
                                    const RigidTransform& to_from_from,
                                    const Eigen::Matrix<double, 6, 6>& root);

}  // namespace facula
