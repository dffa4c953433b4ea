// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/byte_sequence.hpp>
#include <facula/acquire/core/point_cloud.hpp>
#include <facula/acquire/core/rigid_transform.hpp>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace facula {

/// A pose in float, as OctoMap keeps it.
struct GraphPose {
  Eigen::Vector3f translation = Eigen::Vector3f::Zero();         ///< [m]
  Eigen::Quaternionf rotation = Eigen::Quaternionf::Identity();  ///< close to unit length [1]

  /// As octomath::Pose6D::transform() computes it, to the last bit: q x q*, not normalised.
  Eigen::Vector3f operator*(const Eigen::Vector3f& x) const;
};

/// A scan of a log: points in the scanner's frame and its pose.
struct GraphScan {
  std::uint32_t id = 0;
  GraphPose world_from_scan;
  std::vector<Eigen::Vector3f> points;  ///< in the scan frame [m]
};

/// A relation between two scans, which maps do not need.
struct GraphEdge {
  std::uint32_t first = 0;   ///< id
  std::uint32_t second = 0;  ///< id
  GraphPose constraint;
  double weight = 1;  ///< [1]
};

/// A log of scans: OctoMap's ScanGraph.
struct ScanGraph {
  std::vector<GraphScan> scans;
  std::vector<GraphEdge> edges;

  std::size_t points() const;  ///< over all scans [1]
};

/// Reads OctoMap's binary .graph. Little-endian; a vector is a u32 of how many (3) and as many
/// doubles, a quaternion a u32 of 4 and doubles u, x, y, z, a pose a vector and a quaternion:
///   u32 number of scans; per scan u32 number of points, points (vectors), pose, u32 id;
///   u32 number of edges; per edge u32 and u32 ids, pose, double weight.
/// Numbers are rounded to float. Throws Error when the file is missing, torn or damaged: counts
/// are held against the file's length before memory is asked for.
ScanGraph read_scan_graph(const std::filesystem::path& path);

/// The same from memory; `name` is the file's name for messages.
ScanGraph parse_scan_graph(ByteView file, const std::string& name);

/// Writes the bytes of octomap::ScanGraph::writeBinary(), whole or not at all.
void write_scan_graph(const std::filesystem::path& path, const ScanGraph& graph);

/// The scan in the world, seen from its pose, in float as OctoMap's insertPointCloud() places it:
/// maps of it are OctoMap's, byte for byte.
PointCloud world_cloud(const GraphScan& scan);

/// The pose in double: exactly, where the quaternion is as long as rounding allows, so that
/// graph_pose() gives the same pose back; otherwise with its length made 1.
RigidTransform rigid_transform(const GraphPose& pose);

/// The pose in float.
GraphPose graph_pose(const RigidTransform& pose);

}  // namespace facula
