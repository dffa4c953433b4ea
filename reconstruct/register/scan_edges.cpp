// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/parallel.hpp>
#include <facula/reconstruct/register/scan_edges.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>

namespace facula {
namespace {

using Pair = std::pair<std::size_t, std::size_t>;

template <typename Body>
std::vector<ScanEdge> edges_of(const std::vector<Pair>& pairs, int num_threads, const Body& body) {
  std::vector<std::optional<ScanEdge>> found(pairs.size());
  parallel_for(pairs.size(),
               [&](std::size_t begin, std::size_t end) {
                 for (std::size_t k = begin; k < end; ++k) found[k] = body(pairs[k]);
               },
               {.num_threads = num_threads, .chunk = 1});
  std::vector<ScanEdge> edges;
  for (std::optional<ScanEdge>& edge : found) {
    if (edge) edges.push_back(std::move(*edge));
  }
  return edges;
}

/// Where the source's middle goes, by which two poses of it are compared.
double moved_by(const ScanPyramid& source, const RigidTransform& a, const RigidTransform& b) {
  const Eigen::Vector3d middle = middle_of(source.levels.back().cloud);
  return (a * middle - b * middle).norm() + rotation_angle(a.inverse() * b) * source.diameter / 4;
}

void take(const PairResult& pair, const ReadyScans& scans, ScanEdge& edge) {
  edge.edge.to_from_from = pair.target_from_source;
  edge.edge.information = pair.information;
  const double source = static_cast<double>(scans.pyramids[edge.edge.from]->levels[0].cloud.size());
  const double target = static_cast<double>(scans.pyramids[edge.edge.to]->levels[0].cloud.size());
  edge.overlap = std::min(1.0, pair.overlap * source / std::min(source, target));
  edge.inlier_rms = pair.inlier_rms;
}

/// Finds where the two scans meet: the points of the source's coarsest level near the target.
void find_region(const ReadyScans& scans, ScanEdge& edge) {
  const ScanPyramid& source = *scans.pyramids[edge.edge.from];
  const ScanPyramid& target = *scans.pyramids[edge.edge.to];
  const PyramidLevel& a = source.levels.back();
  const PyramidLevel& b = target.levels.back();
  const double reach = std::max(a.voxel, b.voxel);
  std::vector<Eigen::Vector3d> shared;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3f& p : a.cloud.points) {
    const Eigen::Vector3d x = edge.edge.to_from_from * p.cast<double>();
    if (static_cast<double>(b.tree.nearest(x.cast<float>()).squared_distance) > reach * reach) {
      continue;
    }
    shared.push_back(x);
    sum += x;
  }
  edge.radius = a.voxel;
  if (shared.empty()) return;
  const double n = static_cast<double>(shared.size());
  edge.middle = sum / n;
  double squares = 0;
  for (const Eigen::Vector3d& x : shared) squares += (x - edge.middle).squaredNorm();
  edge.radius = std::max(a.voxel, std::sqrt(squares / n));
}

ScanEdge searched(const ReadyScans& scans, const Pair& pair, const RegisterScansOptions& options) {
  ScanEdge edge;
  edge.edge.from = pair.first;
  edge.edge.to = pair.second;
  GlobalOptions how = options.global;
  how.num_threads = 1;
  how.refinement.num_threads = 1;
  try {
    const GlobalResult found =
        register_without_guess(*scans.features[pair.first], *scans.features[pair.second], how);
    take(found.pair, scans, edge);
    if (found.score.overlap > 0) edge.overlap = found.score.overlap;
    edge.reason = found.reason;
    if (found.verdict != Verdict::kAccepted) return edge;
    if (!options.motion.allows(edge.edge.to_from_from)) {
      edge.reason = "the pose found does not keep to the motion of the scanner";
      return edge;
    }
    edge.verdict = EdgeVerdict::kKept;
    find_region(scans, edge);
  } catch (const Error& error) {
    edge.reason = error.what();
  }
  return edge;
}

std::optional<ScanEdge> guessed(const ReadyScans& scans,
                                const Pair& pair,
                                const PoseGuesses& world_from_scan,
                                const GuessedPairs& how,
                                const RegisterScansOptions& options) {
  const ScanPyramid& source = *scans.pyramids[pair.first];
  const ScanPyramid& target = *scans.pyramids[pair.second];
  const RigidTransform guess =
      world_from_scan[pair.second]->inverse() * *world_from_scan[pair.first];
  const double coarse = std::max(source.levels.back().voxel, target.levels.back().voxel);
  const double reach = how.reach > 0 ? how.reach : coarse;
  if (rough_overlap(source, target, guess, reach) < options.min_overlap) return {};
  ScanEdge edge;
  edge.edge.from = pair.first;
  edge.edge.to = pair.second;
  PairOptions alone = how.pair;
  alone.num_threads = 1;
  try {
    const PairResult found = register_pair(source, target, guess, alone);
    take(found, scans, edge);
    const double moved = moved_by(source, found.target_from_source, guess);
    if (how.tolerance == 0 && !found.converged) {
      edge.reason = "it did not settle";
    } else if (how.tolerance > 0 && moved > how.tolerance) {
      edge.reason = "it slid away from the pose that the other scans give";
    } else if (edge.overlap < options.min_overlap) {
      edge.reason = "the two scans share too little";
    } else if (!options.motion.allows(edge.edge.to_from_from)) {
      edge.reason = "the pose found does not keep to the motion of the scanner";
    } else {
      edge.verdict = EdgeVerdict::kKept;
      find_region(scans, edge);
    }
  } catch (const Error& error) {
    edge.reason = error.what();
  }
  return edge;
}

}  // namespace

StageProgress::StageProgress(const Progress& progress, std::size_t total)
    : progress_(progress), total_(total) {}

void StageProgress::add(std::size_t steps) {
  if (!progress_) return;
  const std::lock_guard lock(mutex_);
  done_ = std::min(total_, done_ + steps);
  progress_(done_, total_);
}

std::vector<ScanEdge> search_pairs(const ReadyScans& scans,
                                   const RegisterScansOptions& options,
                                   StageProgress& progress) {
  return edges_of(scans.pairs(), options.num_threads, [&](const Pair& pair) {
    std::optional<ScanEdge> edge = searched(scans, pair, options);
    progress.add(4);
    return edge;
  });
}

std::vector<ScanEdge> register_guessed(const ReadyScans& scans,
                                       const PoseGuesses& world_from_scan,
                                       const GuessedPairs& how,
                                       const RegisterScansOptions& options,
                                       StageProgress& progress) {
  std::vector<Pair> known;
  const std::vector<Pair> all = scans.pairs();
  std::copy_if(all.begin(), all.end(), std::back_inserter(known), [&](const Pair& pair) {
    return world_from_scan[pair.first] && world_from_scan[pair.second];
  });
  progress.add(all.size() - known.size());
  return edges_of(known, options.num_threads, [&](const Pair& pair) {
    std::optional<ScanEdge> edge = guessed(scans, pair, world_from_scan, how, options);
    progress.add(1);
    return edge;
  });
}

}  // namespace facula
