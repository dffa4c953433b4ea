// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/parallel.hpp>
#include <facula/reconstruct/register/feature_candidates.hpp>
#include <facula/reconstruct/register/global_registration.hpp>
#include <facula/reconstruct/register/plane_triples.hpp>
#include <facula/reconstruct/register/pose_verdict.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

namespace facula {
namespace {

constexpr std::size_t kSettled = 32;     // distinct candidates that are moved to where they meet
constexpr std::size_t kMostRefined = 6;  // poses that go through register_pair()
constexpr double kRoughShare = 0.6;      // of the least overlap, before refinement [1]

bool uses_planes(const GlobalFeatures& s, const GlobalFeatures& t, GlobalMethod method) {
  if (method == GlobalMethod::kFeatures) return false;
  return s.planes.size() >= 3 && t.planes.size() >= 3;
}

/// Poses from all the sources the method allows, rough, best first.
std::vector<PoseCandidate> rough_candidates(const GlobalFeatures& source,
                                            const GlobalFeatures& target,
                                            const GlobalOptions& options) {
  std::vector<PoseCandidate> candidates;
  if (uses_planes(source, target, options.method)) {
    candidates = plane_triple_candidates(
        source, target, {.seed = options.seed, .num_threads = options.num_threads});
  }
  if (options.method != GlobalMethod::kPlanes) {
    const auto more = feature_candidates(
        source, target, {.seed = options.seed, .num_threads = options.num_threads});
    candidates.insert(candidates.end(), more.begin(), more.end());
  }
  return distinct_best(std::move(candidates), source, kSettled);
}

/// The candidates moved to where the thinned scans meet, judged by all of their points.
std::vector<PoseCandidate> settled(std::vector<PoseCandidate> candidates,
                                   const GlobalFeatures& source,
                                   const GlobalFeatures& target,
                                   const GlobalOptions& options) {
  const PoseSampler all_points(source, target, source.cloud.size() + target.cloud.size(), 0);
  const auto move = [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      PoseCandidate& c = candidates[i];
      c.target_from_source = settle(source, target, c.target_from_source);
      c.score = all_points.score(c.target_from_source);
    }
  };
  parallel_for(candidates.size(), move, {.num_threads = options.num_threads, .chunk = 1});
  const auto most = static_cast<std::size_t>(options.max_candidates);
  return distinct_best(std::move(candidates), source, most);
}

/// Those that a rough look does not rule out, likeliest first.
std::vector<JudgedPose> plausible(const std::vector<PoseCandidate>& candidates,
                                  const GlobalFeatures& source,
                                  const GlobalFeatures& target,
                                  const GlobalOptions& options) {
  std::vector<JudgedPose> poses;
  for (const PoseCandidate& candidate : candidates) {
    JudgedPose pose;
    pose.pair.target_from_source = candidate.target_from_source;
    pose.score = score_pose({*source.scan, source.view},
                            {*target.scan, target.view},
                            candidate.target_from_source,
                            {.level = 1, .num_threads = options.num_threads});
    poses.push_back(pose);
  }
  std::stable_sort(poses.begin(), poses.end(), [](const JudgedPose& a, const JudgedPose& b) {
    return quality(a.score) > quality(b.score);
  });
  return poses;
}

/// Refined by register_pair() and judged at the finest level; nothing where the pose falls apart.
std::optional<JudgedPose> refined(const JudgedPose& rough,
                                  const GlobalFeatures& source,
                                  const GlobalFeatures& target,
                                  const GlobalOptions& options) {
  PairOptions refinement = options.refinement;
  refinement.num_threads = options.num_threads;
  refinement.coarsest_level = std::min(refinement.coarsest_level, 1);
  try {
    JudgedPose pose;
    pose.pair =
        register_pair(*source.scan, *target.scan, rough.pair.target_from_source, refinement);
    pose.score = score_pose({*source.scan, source.view},
                            {*target.scan, target.view},
                            pose.pair.target_from_source,
                            {.level = 0, .num_threads = options.num_threads});
    return pose;
  } catch (const Error&) {
    return {};  // too little overlap: the pose explains nothing
  }
}

/// The poses refined, each place once, best first.
std::vector<JudgedPose> refined_poses(const std::vector<JudgedPose>& rough,
                                      const GlobalFeatures& source,
                                      const GlobalFeatures& target,
                                      const GlobalOptions& options) {
  const Eigen::Vector3d middle = middle_of(source.cloud);
  std::vector<JudgedPose> poses;
  for (const JudgedPose& start : rough) {
    if (!fits(start.score, kRoughShare * options.min_overlap)) continue;
    if (poses.size() >= kMostRefined) break;
    const auto pose = refined(start, source, target, options);
    if (!pose) continue;
    const bool known = std::any_of(poses.begin(), poses.end(), [&](const JudgedPose& other) {
      const RigidTransform& a = other.pair.target_from_source;
      const RigidTransform& b = pose->pair.target_from_source;
      return a.rotation.angularDistance(b.rotation) < 0.1 &&
             (a * middle - b * middle).norm() < source.voxel;
    });
    if (!known) poses.push_back(*pose);
  }
  std::stable_sort(poses.begin(), poses.end(), [](const JudgedPose& a, const JudgedPose& b) {
    return quality(a.score) > quality(b.score);
  });
  return poses;
}

}  // namespace

void GlobalOptions::check() const {
  require(min_overlap > 0 && min_overlap <= 1,
          "min_overlap is ",
          min_overlap,
          "; give a share above 0 and at most 1");
  require(max_candidates >= 2, "max_candidates is ", max_candidates, "; give at least 2");
  require(num_threads >= 0, "num_threads is ", num_threads, "; give 0 (all cores) or more");
  refinement.check();
}

GlobalResult register_without_guess(const GlobalFeatures& source,
                                    const GlobalFeatures& target,
                                    const GlobalOptions& options) {
  options.check();
  require(source.scan != nullptr && target.scan != nullptr,
          "the scans are not made ready; use find_global_features()");
  require(source.voxel == target.voxel,
          "the features of ",
          source.scan->name,
          " and ",
          target.scan->name,
          " belong to voxels of ",
          source.voxel,
          " and ",
          target.voxel,
          " m; give both the same, as by feature_voxel()");
  const auto candidates =
      settled(rough_candidates(source, target, options), source, target, options);
  const auto rough = plausible(candidates, source, target, options);
  const auto poses = refined_poses(rough, source, target, options);
  return verdict_on(poses, rough, options);
}

GlobalResult register_without_guess(const ScanPyramid& source,
                                    const ScanPyramid& target,
                                    const GlobalOptions& options) {
  options.check();
  const GlobalFeatureOptions features{.voxel = feature_voxel({&source, &target}),
                                      .planes = options.method != GlobalMethod::kFeatures,
                                      .num_threads = options.num_threads};
  return register_without_guess(
      find_global_features(source, features), find_global_features(target, features), options);
}

}  // namespace facula
