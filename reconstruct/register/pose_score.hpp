// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/rigid_transform.hpp>
#include <facula/reconstruct/register/scan_pyramid.hpp>
#include <facula/reconstruct/register/scan_view.hpp>

#include <cstddef>

namespace facula {

/// How well a pose explains two scans, both ways.
struct PoseScore {
  double overlap = 0;     ///< share of points that lie on the other scan, normals agreeing, of the
                          ///< scan that has the larger share [0..1]
  double inlier_rms = 0;  ///< distance of those points from the other's tangent planes [m]
  double contradiction = 0;  ///< points seen where the other scan looked through, as a share of
                             ///< them and those that lie on the other scan [0..1]
  double misfit = 0;         ///< points near the other scan but off its surface, likewise [0..1]
};

/// A scan with its depth image.
struct ScanWithView {
  const ScanPyramid& scan;
  const ScanView& view;
};

struct PoseScoreOptions {
  std::size_t level = 0;  ///< of the scans' surfaces; points of the next coarser are asked [1]
  double scatter = 0;     ///< 1 standard deviation of scans about the surface they share, where it
                          ///< is known to exceed their sampling [m]
  int num_threads = 0;    ///< 0 = all cores [1]
};

/// Judges a pose: points of a level of each scan against the next finer level of the other.
PoseScore score_pose(const ScanPyramid& source,
                     const ScanPyramid& target,
                     const RigidTransform& target_from_source,
                     int num_threads = 0);

/// The same for scans whose depth images are at hand.
PoseScore score_pose(const ScanWithView& source,
                     const ScanWithView& target,
                     const RigidTransform& target_from_source,
                     const PoseScoreOptions& options = {});

}  // namespace facula
