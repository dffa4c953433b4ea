// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/reconstruct/measure/plane.hpp>
#include <facula/reconstruct/register/scan_project.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace facula {

/// How unsure the poses of the scans are that make up a cloud, and which of its points come from
/// which scan. Scans are taken as independent of each other, for poses state no more: of scans that
/// were placed over a common third, the errors they share then count for each, so that relations of
/// their planes come out rather too unsure than too sure.
struct PoseErrors {
  struct Share {
    std::uint32_t scan = 0;
    float share = 1;  ///< of the point that is this scan's, 1 in all [0..1]
  };
  std::vector<Eigen::Matrix<double, 6, 6>> root;  ///< of a scan: its covariance is root root^T
  std::vector<std::size_t> first;  ///< where a point's shares begin, and one more for the end
  std::vector<Share> shares;

  /// Every pose counts as exact.
  bool empty() const { return root.empty(); }
};

/// Of the points of project.fused(); empty where no scan states the covariance of its pose.
PoseErrors pose_errors(const ScanProject& project);

/// Of the same points thinned to `count`, where point i went into voxel_of[i] (thin_by_voxel()):
/// each thinned point is its scans' by the number of points they gave.
PoseErrors thinned(const PoseErrors& errors,
                   const std::vector<std::uint32_t>& voxel_of,
                   std::size_t count);

/// The points of scans and the errors of their poses, for a search of planes.
struct FusedScans {
  PointCloud cloud;
  PoseErrors poses;
  std::size_t doubles = 0;  ///< points left out, for an earlier one stands in the same place [1]
};

/// project.fused(), each place once: a point that stands exactly where another does (of a scan
/// given twice) tells nothing new, would make planes look surer than they are, and hides how far
/// points stand apart. Where there are such points, those that are not finite go with them.
FusedScans fuse_apart(const ScanProject& project);

/// Tells every plane of the cloud how it answers these errors (PlaneFit::pose_response), by fitting
/// it once more.
void add_pose_responses(const PointCloud& cloud,
                        const PoseErrors& errors,
                        std::vector<ExtractedPlane>& planes);

}  // namespace facula
