// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/rigid_transform.hpp>
#include <facula/acquire/core/scan_stand.hpp>
#include <facula/reconstruct/register/pose_graph.hpp>

#include <Eigen/Core>

namespace facula {

/// What is known beforehand about how scans lie to each other.
struct ScanMotion {
  ScanStand kind = ScanStand::kFree;                ///< with `axis` in the place of z
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();  ///< in every scan's frame, of any length [1]
  double angle_sigma = 0.005;   ///< how far the axes may lean to each other, 1 std. deviation [rad]
  double height_sigma = 0.001;  ///< of the shift along the axis (kTable) [m]

  void check() const;

  /// Whether a pose keeps to the motion within five standard deviations.
  bool allows(const RigidTransform& target_from_source) const;

  /// The motion as a measurement for a pose graph, about the pose as it is now: it weighs how far
  /// the pose leans (and rises) and leaves all else open.
  PoseEdge as_edge(std::size_t from, std::size_t to, const RigidTransform& to_from_from) const;
};

}  // namespace facula
