// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/rigid_transform.hpp>
#include <facula/reconstruct/register/global_features.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace facula {

/// A pose that may be right.
struct PoseCandidate {
  RigidTransform target_from_source;
  double score = 0;  ///< points that meet less those in free space, of those asked [-1..1]
};

/// Source and target thinned to some points each, to judge many poses roughly in little time.
class PoseSampler {
 public:
  /// `count` points of each scan at most, drawn with the seed.
  PoseSampler(const GlobalFeatures& source,
              const GlobalFeatures& target,
              std::size_t count,
              std::uint64_t seed);

  /// Share of the points that lie on the other scan with normals agreeing, less the share in front
  /// of what the other scan saw; the better of both ways. Gives up early, with -1, on poses that
  /// are clearly below `least`.
  double score(const RigidTransform& target_from_source, double least = -1) const;

 private:
  const GlobalFeatures& source_;
  const GlobalFeatures& target_;
  std::vector<std::uint32_t> source_points_;
  std::vector<std::uint32_t> target_points_;
};

/// Best first, of equally good ones the first given; those within 12 degrees and two voxels (at the
/// source's middle) of a better one are dropped.
std::vector<PoseCandidate> distinct_best(std::vector<PoseCandidate> candidates,
                                         const GlobalFeatures& source,
                                         std::size_t most);

/// The candidate moved to where the thinned scans meet best: point-to-plane steps with
/// correspondences looked up in the target's grid.
RigidTransform settle(const GlobalFeatures& source,
                      const GlobalFeatures& target,
                      const RigidTransform& target_from_source);

}  // namespace facula
