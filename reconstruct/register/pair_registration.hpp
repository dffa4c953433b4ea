// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/rigid_transform.hpp>
#include <facula/reconstruct/register/scan_pyramid.hpp>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace facula {

/// What is made small between corresponding points.
enum class PairMethod : std::uint8_t {
  kPointToPlane,  ///< distance to the target's tangent plane (Chen and Medioni 1992)
  kGeneralized,   ///< plane to plane, weighted by both local covariances (Segal et al. 2009)
};

/// How a correspondence's weight falls with its residual.
enum class RobustKernel : std::uint8_t { kNone, kHuber, kCauchy, kGemanMcClure, kTukey };

struct PairOptions {
  PairMethod method = PairMethod::kGeneralized;
  RobustKernel kernel = RobustKernel::kGemanMcClure;
  double max_distance = 0;  ///< farthest correspondence at the start [m]; 0 = 4 coarsest voxels
  double min_distance =
      0;  ///< the bound shrinks to this as the scans meet [m]; 0 = 2 finest voxels
  int max_iterations = 100;           ///< over all levels [1], at least 1
  double rotation_epsilon = 1e-6;     ///< converged when a step turns less [rad]
  double translation_epsilon = 1e-7;  ///< and moves less [m]
  double significance = 0.02;         ///< or when a step is this much of the pose's own sigma [1]
  double max_normal_angle = 0.8;      ///< between the two normals of a correspondence [rad]
  int coarsest_level = 8;  ///< start here, or at the last level there is [1]; 0 = finest only
  int num_threads = 0;     ///< 0 = all cores [1]

  void check() const;
};

/// A motion the overlap does not decide.
struct UndecidedDirection {
  Eigen::Matrix<double, 6, 1> twist;  ///< unit, about the overlap's centroid: (m, rad * radius)
  double sigma = 0;                   ///< 1 standard deviation along it, infinite if unknown [m]
  std::string motion;  ///< for people: "slides along (0.98, 0.17, 0.01)", "turns about ..."
};

struct PairResult {
  RigidTransform target_from_source;
  bool converged = false;
  int iterations = 0;       ///< over all levels [1]
  std::size_t inliers = 0;  ///< correspondences at the end [1]
  double overlap = 0;       ///< share of source points with a correspondence [0..1]
  double inlier_rms = 0;    ///< point to plane, over the inliers [m]

  /// Of the twist e = (translation [m], rotation [rad]) in true pose = exp_se3(e) * estimate.
  Eigen::Matrix<double, 6, 6> information = Eigen::Matrix<double, 6, 6>::Zero();
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
  std::vector<UndecidedDirection> undecided;  ///< empty when all six are held
};

/// Moves source onto target from a guess, coarse to fine. An undecided direction is left as the
/// guess has it and named in the result. Throws Error when too few points correspond.
PairResult register_pair(const ScanPyramid& source,
                         const ScanPyramid& target,
                         const RigidTransform& target_from_source_guess,
                         const PairOptions& options = {});

}  // namespace facula
