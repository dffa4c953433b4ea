// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/rigid_transform.hpp>
#include <facula/reconstruct/register/pair_registration.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace facula {

/// A source point and the target point nearest to it, in the target frame.
struct PointPair {
  std::uint32_t source = 0;       ///< index in the source level's cloud [1]
  std::uint32_t target = 0;       ///< index in the target level's cloud [1]
  double distance = 0;            ///< between the two points [m]
  double residual = 0;            ///< of `offset` along `normal`, in standard deviations [1]
  double plane_distance = 0;      ///< the same [m]
  Eigen::Vector3d point;          ///< the source point [m]
  Eigen::Vector3d offset;         ///< source point - target point [m]
  Eigen::Vector3d source_normal;  ///< unit, on the target normal's side [1]
  Eigen::Vector3d target_normal;  ///< unit [1]
  Eigen::Matrix3d weight;         ///< inverse covariance of `offset` [1/m^2]
};

/// Which levels meet, how near and how.
struct PairSearch {
  const PyramidLevel& source;
  const PyramidLevel& target;
  bool sided = false;       ///< normals of a pair must face the same way
  double max_distance = 0;  ///< [m]
  const PairOptions& options;
};

/// One pair for every source point whose nearest target point lies within max_distance and has a
/// normal that agrees, in the order of the source points. Weights follow from the sigmas along the
/// rays where both scans have them, otherwise from the levels' voxels.
std::vector<PointPair> find_pairs(const PairSearch& search,
                                  const RigidTransform& target_from_source);

}  // namespace facula
