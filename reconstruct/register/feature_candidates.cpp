// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/parallel.hpp>
#include <facula/acquire/core/random.hpp>
#include <facula/reconstruct/register/feature_candidates.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

#include <Eigen/Geometry>

namespace facula {
namespace {

constexpr double kShortestEdge = 6;    // between the two points of a trial [voxels]
constexpr double kEdgeSlack = 1.5;     // of the two edges' lengths [voxels]
constexpr float kAngleSlack = 0.25F;   // of cosines of normals with the edge and each other [1]
constexpr std::size_t kChunk = 4096;   // trials with random numbers of their own
constexpr std::size_t kSamples = 128;  // points by which a trial's pose is judged

struct OrientedPoint {
  Eigen::Vector3f point;
  Eigen::Vector3f normal;
};

struct Edge {
  OrientedPoint a;
  OrientedPoint b;
};

OrientedPoint point_of(const GlobalFeatures& scan, std::uint32_t index) {
  return {scan.cloud.points[index], scan.cloud.normals[index]};
}

/// Whether a rigid motion can bring one edge onto the other (the features of Drost et al. 2010).
bool edges_agree(const Edge& s, const Edge& t, double voxel) {
  const Eigen::Vector3f ds = s.b.point - s.a.point;
  const Eigen::Vector3f dt = t.b.point - t.a.point;
  const float ls = ds.norm();
  const float lt = dt.norm();
  if (ls < kShortestEdge * voxel || std::abs(ls - lt) > kEdgeSlack * voxel) return false;
  return std::abs(s.a.normal.dot(s.b.normal) - t.a.normal.dot(t.b.normal)) < kAngleSlack &&
         std::abs(s.a.normal.dot(ds) / ls - t.a.normal.dot(dt) / lt) < kAngleSlack &&
         std::abs(s.b.normal.dot(ds) / ls - t.b.normal.dot(dt) / lt) < kAngleSlack;
}

/// Axes along the edge and, square to it, along the sum of the normals; nothing where that
/// vanishes.
std::optional<Eigen::Matrix3d> axes_of(const Edge& edge) {
  const Eigen::Vector3d x = (edge.b.point - edge.a.point).cast<double>().normalized();
  const Eigen::Vector3d sum = (edge.a.normal + edge.b.normal).cast<double>();
  const Eigen::Vector3d across = sum - x.dot(sum) * x;
  if (across.norm() < 0.4) return {};
  Eigen::Matrix3d axes;
  axes.col(0) = x;
  axes.col(1) = across.normalized();
  axes.col(2) = x.cross(axes.col(1));
  return axes;
}

std::optional<RigidTransform> pose_of(const Edge& s, const Edge& t) {
  const auto source_axes = axes_of(s);
  const auto target_axes = axes_of(t);
  if (!source_axes || !target_axes) return {};
  RigidTransform pose;
  pose.rotation = Eigen::Quaterniond(*target_axes * source_axes->transpose()).normalized();
  const Eigen::Vector3d from = (s.a.point + s.b.point).cast<double>() / 2;
  const Eigen::Vector3d to = (t.a.point + t.b.point).cast<double>() / 2;
  pose.translation = to - pose.rotation * from;
  // Each of the four normals must come near its partner: the sum alone could hide a twist.
  for (const auto& [a, b] :
       {std::pair(s.a.normal, t.a.normal), std::pair(s.b.normal, t.b.normal)}) {
    if ((pose.rotation * a.cast<double>()).dot(b.cast<double>()) < 0.8) return {};
  }
  return pose;
}

void keep_best(std::vector<PoseCandidate>& candidates, std::size_t most) {
  if (candidates.size() <= most) return;
  std::stable_sort(candidates.begin(), candidates.end(), [](const auto& a, const auto& b) {
    return a.score > b.score;
  });
  candidates.resize(most);
}

}  // namespace

std::vector<FeatureMatch> match_features(const GlobalFeatures& source,
                                         const GlobalFeatures& target,
                                         const FeatureCandidateOptions& options) {
  const auto one_way = [&](const GlobalFeatures& from, const GlobalFeatures& to) {
    std::vector<std::vector<std::uint32_t>> found(from.features.size());
    const auto search = [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        if (!std::isfinite(from.features[i][0])) continue;
        found[i] = to.tree->nearest(from.features[i], options.neighbours);
      }
    };
    parallel_for(from.features.size(), search, {.num_threads = options.num_threads, .chunk = 64});
    return found;
  };
  std::vector<FeatureMatch> matches;
  const auto there = one_way(source, target);
  for (std::size_t i = 0; i < there.size(); ++i) {
    for (const std::uint32_t j : there[i]) matches.push_back({static_cast<std::uint32_t>(i), j});
  }
  const auto back = one_way(target, source);
  for (std::size_t j = 0; j < back.size(); ++j) {
    for (const std::uint32_t i : back[j]) matches.push_back({i, static_cast<std::uint32_t>(j)});
  }
  std::sort(matches.begin(), matches.end(), [](const FeatureMatch& a, const FeatureMatch& b) {
    return a.source != b.source ? a.source < b.source : a.target < b.target;
  });
  // Keep those found both ways: each is among the other's nearest.
  std::vector<FeatureMatch> mutual;
  for (std::size_t k = 0; k + 1 < matches.size(); ++k) {
    if (matches[k] == matches[k + 1]) mutual.push_back(matches[k]);
  }
  return mutual;
}

std::vector<PoseCandidate> feature_candidates(const GlobalFeatures& source,
                                              const GlobalFeatures& target,
                                              const FeatureCandidateOptions& options) {
  const std::vector<FeatureMatch> matches = match_features(source, target, options);
  if (matches.size() < 2) return {};
  const PoseSampler sampler(source, target, kSamples, options.seed);
  const auto trials = static_cast<std::size_t>(options.trials);
  const auto kept = static_cast<std::size_t>(options.kept);
  std::vector<std::vector<PoseCandidate>> found((trials + kChunk - 1) / kChunk);
  const auto draw = [&](std::size_t begin, std::size_t end) {
    Random random(options.seed, begin / kChunk);
    std::vector<PoseCandidate>& best = found[begin / kChunk];
    for (std::size_t trial = begin; trial < end; ++trial) {
      const FeatureMatch& a = matches[random.below(matches.size())];
      const FeatureMatch& b = matches[random.below(matches.size())];
      const Edge s{point_of(source, a.source), point_of(source, b.source)};
      const Edge t{point_of(target, a.target), point_of(target, b.target)};
      if (!edges_agree(s, t, source.voxel)) continue;
      const auto pose = pose_of(s, t);
      if (!pose) continue;
      const double score = sampler.score(*pose, 0.1);
      if (score > 0) best.push_back({*pose, score});
    }
    keep_best(best, kept);
  };
  parallel_for(trials, draw, {.num_threads = options.num_threads, .chunk = kChunk});
  std::vector<PoseCandidate> all;
  for (const auto& part : found) all.insert(all.end(), part.begin(), part.end());
  keep_best(all, kept);
  return all;
}

}  // namespace facula
