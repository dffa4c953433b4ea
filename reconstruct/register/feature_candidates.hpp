// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/reconstruct/register/pose_candidates.hpp>

#include <cstdint>
#include <vector>

namespace facula {

struct FeatureCandidateOptions {
  std::uint64_t seed = 1;  ///< [1]
  int neighbours = 8;      ///< features matched with each, both ways [1]
  int trials = 20000;      ///< pairs of matches drawn [1]
  int kept = 256;          ///< best poses kept [1]
  int num_threads = 0;     ///< 0 = all cores [1]
};

/// Pairs of points of the source and the target whose features are near each other's.
std::vector<FeatureMatch> match_features(const GlobalFeatures& source,
                                         const GlobalFeatures& target,
                                         const FeatureCandidateOptions& options);

/// Poses from pairs of matches (RANSAC; two points with normals fix a pose, as in Drost et al.
/// 2010), best first. The same for every number of threads.
std::vector<PoseCandidate> feature_candidates(const GlobalFeatures& source,
                                              const GlobalFeatures& target,
                                              const FeatureCandidateOptions& options);

}  // namespace facula
