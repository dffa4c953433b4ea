// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/parallel.hpp>
#include <facula/reconstruct/register/pose_score.hpp>

#include <algorithm>
#include <cmath>

namespace facula {
namespace {

constexpr double kNear = 1.5;  // nearest point on the same piece of surface [voxels of the surface]
constexpr double kOnSurface = 0.6;  // distance from its tangent plane [voxels of the surface]
constexpr double kOffSurface =
    4;  // farther away: not a misfit, another surface [voxels of the surface]
constexpr double kScatters = 2;     // that count as on the surface [1]
constexpr double kMinCosine = 0.8;  // between two normals that agree
constexpr double kFree = 3;         // in front of what was seen by this [voxels of the surface]
constexpr std::size_t kMaxQueries = 6000;  // of one scan

struct Tally {
  std::size_t asked = 0;
  std::size_t meet = 0;
  std::size_t off = 0;
  std::size_t free = 0;
  double squares = 0;

  Tally operator+(const Tally& o) const {
    return {asked + o.asked, meet + o.meet, off + o.off, free + o.free, squares + o.squares};
  }
};

class OneWay {
 public:
  OneWay(const ScanPyramid& from,
         const ScanWithView& to,
         const RigidTransform& to_from_from,
         const PoseScoreOptions& options)
      : asked_(level_of(from, options.level + 1)),
        surface_(level_of(to.scan, options.level)),
        view_(to.view),
        pose_(to_from_from),
        voxel_(std::max({level_of(from, options.level).voxel,
                         surface_.voxel,
                         kScatters * options.scatter / kOnSurface})),
        sided_(from.oriented && to.scan.oriented),
        stride_((asked_.cloud.size() + kMaxQueries - 1) / kMaxQueries) {}

  Tally tally(int num_threads) const {
    const std::size_t queries = (asked_.cloud.size() + stride_ - 1) / stride_;
    return parallel_reduce(
        queries,
        Tally{},
        [&](std::size_t begin, std::size_t end) {
          Tally part;
          for (std::size_t i = begin; i < end; ++i) judge(i * stride_, part);
          return part;
        },
        [](const Tally& a, const Tally& b) { return a + b; },
        {.num_threads = num_threads, .chunk = 512});
  }

 private:
  static const PyramidLevel& level_of(const ScanPyramid& scan, std::size_t level) {
    return scan.levels[std::min(level, scan.levels.size() - 1)];
  }

  void judge(std::size_t i, Tally& tally) const {
    const PointCloud& cloud = asked_.cloud;
    if (!cloud.points[i].allFinite()) return;
    ++tally.asked;
    const Eigen::Vector3d x = pose_ * cloud.points[i].cast<double>();
    const auto nearest = surface_.tree.nearest(x.cast<float>());
    const double distance = std::sqrt(static_cast<double>(nearest.squared_distance));
    if (distance < kOffSurface * voxel_) {
      const Eigen::Vector3d normal = surface_.cloud.normals[nearest.index].cast<double>();
      const Eigen::Vector3d gap = x - surface_.cloud.points[nearest.index].cast<double>();
      const double off = normal.dot(gap);
      const double aside = (gap - off * normal).norm();
      if (aside < kNear * voxel_) {
        const double turned = normal.dot(pose_.rotation * cloud.normals[i].cast<double>());
        const bool agree = (sided_ ? turned : std::abs(turned)) > kMinCosine;
        if (agree && std::abs(off) < kOnSurface * voxel_) {
          ++tally.meet;
          tally.squares += off * off;
          return;
        }
        ++tally.off;
      }
    }
    if (view_.at(x, kFree * voxel_) == Seen::kFree) ++tally.free;
  }

  const PyramidLevel& asked_;
  const PyramidLevel& surface_;
  const ScanView& view_;
  const RigidTransform& pose_;
  double voxel_;
  bool sided_;
  std::size_t stride_;
};

double share(std::size_t part, std::size_t of) {
  return of == 0 ? 0 : static_cast<double>(part) / static_cast<double>(of);
}

}  // namespace

PoseScore score_pose(const ScanWithView& source,
                     const ScanWithView& target,
                     const RigidTransform& target_from_source,
                     const PoseScoreOptions& options) {
  require(!source.scan.levels.empty() && !target.scan.levels.empty(),
          "a scan has no levels; use build_pyramid()");
  const RigidTransform source_from_target = target_from_source.inverse();
  const Tally there =
      OneWay(source.scan, target, target_from_source, options).tally(options.num_threads);
  const Tally back =
      OneWay(target.scan, source, source_from_target, options).tally(options.num_threads);
  const Tally both = there + back;
  PoseScore score;
  score.overlap = std::max(share(there.meet, there.asked), share(back.meet, back.asked));
  if (both.meet > 0) {
    score.inlier_rms = std::sqrt(both.squares / static_cast<double>(both.meet));
  }
  score.contradiction = share(both.free, both.free + both.meet);
  score.misfit = share(both.off, both.off + both.meet);
  return score;
}

PoseScore score_pose(const ScanPyramid& source,
                     const ScanPyramid& target,
                     const RigidTransform& target_from_source,
                     int num_threads) {
  require(!source.levels.empty() && !target.levels.empty(),
          "a scan has no levels; use build_pyramid()");
  const ScanView source_view(source.levels.front().cloud, source.levels.front().voxel);
  const ScanView target_view(target.levels.front().cloud, target.levels.front().voxel);
  return score_pose({source, source_view},
                    {target, target_view},
                    target_from_source,
                    {.num_threads = num_threads});
}

}  // namespace facula
