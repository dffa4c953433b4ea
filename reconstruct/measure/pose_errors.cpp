// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/reconstruct/filter/cloud_filters.hpp>
#include <facula/reconstruct/filter/distinct_points.hpp>
#include <facula/reconstruct/measure/pose_errors.hpp>

#include <algorithm>

#include <Eigen/Eigenvalues>

namespace facula {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;

/// root root^T = covariance; rounding may have left it a little below zero somewhere.
Matrix6 root_of(const Matrix6& covariance) {
  const Eigen::SelfAdjointEigenSolver<Matrix6> solver(covariance);
  return solver.eigenvectors() * solver.eigenvalues().cwiseMax(0).cwiseSqrt().asDiagonal();
}

/// A point of a scan and the voxel it went into.
struct Merged {
  std::uint32_t voxel;
  PoseErrors::Share part;
};

}  // namespace

PoseErrors pose_errors(const ScanProject& project) {
  PoseErrors errors;
  const bool exact =
      std::all_of(project.scans.begin(), project.scans.end(), [](const PosedCloud& scan) {
        return scan.pose_covariance.isZero(0);
      });
  if (exact) return errors;
  for (const PosedCloud& scan : project.scans) {
    require(scan.pose_covariance.allFinite(),
            "the covariance of the pose of scan '",
            scan.name,
            "' is not finite; register the scans again");
    const auto number = static_cast<std::uint32_t>(errors.root.size());
    errors.root.push_back(root_of(scan.pose_covariance));
    errors.shares.insert(errors.shares.end(), scan.cloud.size(), {number, 1});
  }
  for (std::size_t i = 0; i <= errors.shares.size(); ++i) errors.first.push_back(i);
  return errors;
}

PoseErrors thinned(const PoseErrors& errors,
                   const std::vector<std::uint32_t>& voxel_of,
                   std::size_t count) {
  if (errors.empty()) return errors;
  require(voxel_of.size() + 1 == errors.first.size(),
          "expected the voxel of every one of ",
          errors.first.size() - 1,
          " points, got those of ",
          voxel_of.size());
  std::vector<Merged> merged;
  for (std::size_t i = 0; i < voxel_of.size(); ++i) {
    if (voxel_of[i] >= count) continue;
    for (std::size_t k = errors.first[i]; k < errors.first[i + 1]; ++k) {
      merged.push_back({voxel_of[i], errors.shares[k]});
    }
  }
  std::stable_sort(merged.begin(), merged.end(), [](const Merged& a, const Merged& b) {
    return a.voxel != b.voxel ? a.voxel < b.voxel : a.part.scan < b.part.scan;
  });
  PoseErrors result;
  result.root = errors.root;
  result.first.push_back(0);
  auto at = merged.begin();
  for (std::uint32_t voxel = 0; voxel < count; ++voxel) {
    const std::size_t begin = result.shares.size();
    float sum = 0;
    for (; at != merged.end() && at->voxel == voxel; ++at) {
      sum += at->part.share;
      if (result.shares.size() > begin && result.shares.back().scan == at->part.scan) {
        result.shares.back().share += at->part.share;
      } else {
        result.shares.push_back(at->part);
      }
    }
    for (std::size_t k = begin; k < result.shares.size(); ++k) result.shares[k].share /= sum;
    result.first.push_back(result.shares.size());
  }
  return result;
}

FusedScans fuse_apart(const ScanProject& project) {
  FusedScans fused{.cloud = project.fused(), .poses = pose_errors(project)};
  const std::vector<std::size_t> kept = distinct_points(fused.cloud.points);
  const auto finite = std::count_if(fused.cloud.points.begin(),
                                    fused.cloud.points.end(),
                                    [](const Eigen::Vector3f& p) { return p.allFinite(); });
  fused.doubles = static_cast<std::size_t>(finite) - kept.size();
  if (fused.doubles == 0) return fused;
  std::vector<std::uint32_t> place(fused.cloud.size(), kNoVoxel);
  for (std::size_t k = 0; k < kept.size(); ++k) place[kept[k]] = static_cast<std::uint32_t>(k);
  fused.poses = thinned(fused.poses, place, kept.size());
  fused.cloud = selected(fused.cloud, kept);
  return fused;
}

void add_pose_responses(const PointCloud& cloud,
                        const PoseErrors& errors,
                        std::vector<ExtractedPlane>& planes) {
  if (errors.empty()) return;
  for (ExtractedPlane& plane : planes) {
    plane.fit = fit_plane(cloud, plane.indices, {.poses = &errors});
  }
}

}  // namespace facula
