// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/median.hpp>
#include <facula/acquire/core/random.hpp>
#include <facula/reconstruct/register/pose_candidates.hpp>
#include <facula/reconstruct/register/twist.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>

#include <Eigen/Cholesky>

namespace facula {
namespace {

constexpr float kMeetVoxels = 1.0F;  // a point this near, along the normal, lies on the other
constexpr float kMinCosine = 0.8F;   // of the angle between two normals that agree
constexpr double kOffWeight = 0.5;
constexpr double kFreeWeight = 2;
constexpr double kFreeVoxels = 2.5;     // in front of the surface by this: in free space
constexpr double kSameRotation = 0.21;  // [rad]
constexpr double kSameShift = 2;        // [voxels]
constexpr int kSettleSteps = 12;
constexpr double kSettleDamping = 1e-3;  // keeps directions that the overlap leaves open

std::vector<std::uint32_t> drawn(std::size_t of, std::size_t count, Random& random) {
  std::vector<std::uint32_t> all(of);
  std::iota(all.begin(), all.end(), 0U);
  if (count >= of) return all;
  for (std::size_t i = 0; i < count; ++i) std::swap(all[i], all[i + random.below(of - i)]);
  all.resize(count);
  return all;
}

/// Single precision: rough poses only, and looked up many million times.
struct Motion {
  Eigen::Matrix3f rotation;
  Eigen::Vector3f translation;

  explicit Motion(const RigidTransform& pose)
      : rotation(pose.rotation.toRotationMatrix().cast<float>()),
        translation(pose.translation.cast<float>()) {}
};

struct Tally {
  int meet = 0;
  int off = 0;   // near the other scan's points, but off its surface or turned away from it
  int free = 0;  // where the other scan looked through

  double score() const { return meet - kOffWeight * off - kFreeWeight * free; }
};

void judge(const GlobalFeatures& from,
           std::uint32_t point,
           const Motion& motion,
           const GlobalFeatures& to,
           Tally& tally) {
  const Eigen::Vector3f x = motion.rotation * from.cloud.points[point] + motion.translation;
  const std::int32_t near = to.near.near(x);
  if (near != NearestGrid::kNone) {
    const Eigen::Vector3f& normal = to.cloud.normals[near];
    const float off = std::abs(normal.dot(x - to.cloud.points[near]));
    const bool turned = normal.dot(motion.rotation * from.cloud.normals[point]) < kMinCosine;
    if (off < kMeetVoxels * static_cast<float>(to.voxel)) {
      ++(turned ? tally.off : tally.meet);
      return;
    }
    ++tally.off;
  }
  if (to.view.at(x.cast<double>(), kFreeVoxels * to.voxel) == Seen::kFree) ++tally.free;
}

}  // namespace

PoseSampler::PoseSampler(const GlobalFeatures& source,
                         const GlobalFeatures& target,
                         std::size_t count,
                         std::uint64_t seed)
    : source_(source), target_(target) {
  Random random(seed, 0x5a5a);
  source_points_ = drawn(source.cloud.size(), count, random);
  target_points_ = drawn(target.cloud.size(), count, random);
}

double PoseSampler::score(const RigidTransform& target_from_source, double least) const {
  const auto one_way = [least](const GlobalFeatures& from,
                               const std::vector<std::uint32_t>& points,
                               const Motion& motion,
                               const GlobalFeatures& to) {
    Tally tally;
    for (std::size_t i = 0; i < points.size(); ++i) {
      judge(from, points[i], motion, to, tally);
      // An eighth of the points is enough to see that a pose is far below the least.
      if (i + 1 == points.size() / 8 &&
          tally.score() < 0.4 * least * static_cast<double>(i + 1) - 1) {
        return -1.0;
      }
    }
    return tally.score() / static_cast<double>(points.size());
  };
  const double there = one_way(source_, source_points_, Motion(target_from_source), target_);
  if (there <= -1) return -1;
  const double back =
      one_way(target_, target_points_, Motion(target_from_source.inverse()), source_);
  return back <= -1 ? -1 : (there + back) / 2;
}

std::vector<PoseCandidate> distinct_best(std::vector<PoseCandidate> candidates,
                                         const GlobalFeatures& source,
                                         std::size_t most) {
  std::stable_sort(candidates.begin(), candidates.end(), [](const auto& a, const auto& b) {
    return a.score > b.score;
  });
  const Eigen::Vector3d middle = middle_of(source.cloud);
  std::vector<PoseCandidate> best;
  for (const PoseCandidate& candidate : candidates) {
    if (best.size() >= most) break;
    const bool known = std::any_of(best.begin(), best.end(), [&](const PoseCandidate& b) {
      const RigidTransform& pose = candidate.target_from_source;
      return b.target_from_source.rotation.angularDistance(pose.rotation) < kSameRotation &&
             (b.target_from_source * middle - pose * middle).norm() < kSameShift * source.voxel;
    });
    if (!known) best.push_back(candidate);
  }
  return best;
}

RigidTransform settle(const GlobalFeatures& source,
                      const GlobalFeatures& target,
                      const RigidTransform& target_from_source) {
  RigidTransform pose = target_from_source;
  for (int step = 0; step < kSettleSteps; ++step) {
    const Motion motion(pose);
    const double scale = target.voxel * (step < kSettleSteps / 2 ? 1.0 : 0.5);
    const Eigen::Vector3d pivot = pose.translation;
    Matrix6 h = Matrix6::Zero();
    Vector6 g = Vector6::Zero();
    int pairs = 0;
    for (std::size_t i = 0; i < source.cloud.size(); ++i) {
      const Eigen::Vector3f x = motion.rotation * source.cloud.points[i] + motion.translation;
      const std::int32_t near = target.near.near(x);
      if (near == NearestGrid::kNone) continue;
      const Eigen::Vector3f& normal = target.cloud.normals[near];
      if (normal.dot(motion.rotation * source.cloud.normals[i]) < 0.7F) continue;
      const double residual = normal.dot(x - target.cloud.points[near]);
      Vector6 jacobian;
      const Eigen::Vector3d n = normal.cast<double>();
      jacobian << n, (x.cast<double>() - pivot).cross(n);
      const double weight = std::pow(scale * scale / (scale * scale + residual * residual), 2);
      h.selfadjointView<Eigen::Lower>().rankUpdate(jacobian, weight);
      g += weight * residual * jacobian;
      ++pairs;
    }
    if (pairs < 12) return pose;
    h.diagonal() *= 1 + kSettleDamping;
    const Vector6 twist = -h.selfadjointView<Eigen::Lower>().ldlt().solve(g);
    if (!twist.allFinite()) return pose;
    pose = turn_about(pivot, twist) * pose;
    if (twist.head<3>().norm() < 1e-3 * target.voxel && twist.tail<3>().norm() < 1e-4) break;
  }
  pose.rotation.normalize();
  return pose;
}

}  // namespace facula
