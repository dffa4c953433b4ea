// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/point_cloud.hpp>
#include <facula/acquire/core/rigid_transform.hpp>
#include <facula/acquire/core/scan_grid.hpp>
#include <facula/acquire/core/scan_stand.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace facula {

/// One scan of a project: its cloud in its own frame, with sensor origins, and its pose.
struct PosedCloud {
  std::string name;
  std::filesystem::path file;
  PointCloud cloud;
  RigidTransform world_from_scan;
  ScanGrid grid;                       ///< of the cloud's points; empty where the file has none
  ScanStand stand = ScanStand::kFree;  ///< against other scans that say the same

  /// Covariance of the twist e in true pose = exp_se3(e) * world_from_scan [m^2, m rad, rad^2],
  /// against the scan that stayed where it was; zero of that one, and where nobody stated it.
  Eigen::Matrix<double, 6, 6> pose_covariance = Eigen::Matrix<double, 6, 6>::Zero();
};

/// Several scans with their poses.
struct ScanProject {
  std::vector<PosedCloud> scans;

  /// What all scans say of how they stand to each other; kFree where they differ.
  ScanStand stand() const;

  /// All points in the world frame.
  PointCloud fused() const;
};

/// Reads posed scans:
///   poses.toml           [[scan]] tables with name, file, translation_mm, quaternion_xyzw (a pose
///                        here wins over the VIEWPOINT of the scan's own file) and
///                        covariance_m_rad, the upper triangle of pose_covariance row by row; or
///                        its folder
///   *.conf               Stanford range scans (`bmesh FILE tx ty tz qx qy qz qw`; x_in_world =
///                        R(conj(q)) x + t; the `camera` line is not a sensor origin)
///   a folder of 3DTK     scanNNN.3d + scanNNN.pose: centimetres, left-handed, Euler angles; ranges
///                        outside `min`..`max` of config.ini are dropped; turned to z up, metres;
///                        a scanNNN.3d file alone is one such scan
///   a single scan file   .pcd, .ply, .asc, .xyz: one scan, with its VIEWPOINT
///   a list of ranges     .csv with the columns range_mm, pan_deg, tilt_deg (pan_tilt_list.hpp)
/// Scan files may be compressed (.gz, .xz). Throws Error as the file readers do.
ScanProject read_scan_project(const std::filesystem::path& path);

/// Writes poses.toml beside the scans it names (paths relative to it where possible).
void write_poses(const std::filesystem::path& path, const ScanProject& project);

}  // namespace facula
