// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/whole_file.hpp>
#include <facula/apps/commands/octomap_log.hpp>

#include <algorithm>
#include <cstdint>
#include <memory>

namespace facula {
namespace {

PosedCloud posed_cloud(const GraphScan& scan,
                       const std::string& name,
                       const std::filesystem::path& file) {
  PosedCloud posed;
  posed.name = name;
  posed.file = file;
  posed.cloud.points = scan.points;
  posed.cloud.sensor_origin.assign(scan.points.size(), Eigen::Vector3f::Zero());
  posed.world_from_scan = rigid_transform(scan.world_from_scan);
  return posed;
}

/// Where the scan's points were seen from, in its own frame.
Eigen::Vector3f mean_origin(const PointCloud& cloud) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double count = 0;
  for (std::size_t i = 0; i < cloud.sensor_origin.size(); ++i) {
    if (!cloud.points[i].allFinite()) continue;
    sum += cloud.sensor_origin[i].cast<double>();
    ++count;
  }
  return (sum / std::max(1.0, count)).cast<float>();
}

GraphScan graph_scan(const PosedCloud& scan, std::size_t id) {
  const Eigen::Vector3f origin = mean_origin(scan.cloud);
  RigidTransform world_from_origin = scan.world_from_scan;
  world_from_origin.translation = scan.world_from_scan * origin.cast<double>();
  GraphScan made;
  made.id = static_cast<std::uint32_t>(id);
  made.world_from_scan = graph_pose(world_from_origin);
  for (const Eigen::Vector3f& x : scan.cloud.points) {
    if (x.allFinite()) made.points.emplace_back(x - origin);
  }
  return made;
}

}  // namespace

bool is_octomap_log(const std::filesystem::path& file) {
  return lower_extension(file) == ".graph";
}

std::vector<ListedScan> list_log(const std::filesystem::path& path) {
  const auto graph = std::make_shared<const ScanGraph>(read_scan_graph(path));
  std::vector<ListedScan> scans;
  for (std::size_t i = 0; i < graph->scans.size(); ++i) {
    const std::string name = path.stem().string() + "_" + std::to_string(i);
    scans.push_back({.name = name, .file = path, .read = [graph, i, name, path] {
                       return posed_cloud(graph->scans[i], name, path);
                     }});
  }
  return scans;
}

ScanGraph log_of(const ScanProject& project) {
  ScanGraph log;
  for (const PosedCloud& scan : project.scans) {
    log.scans.push_back(graph_scan(scan, log.scans.size()));
  }
  return log;
}

PointCloud in_world(const PosedCloud& scan) {
  if (!is_octomap_log(scan.file)) return transformed(scan.cloud, scan.world_from_scan);
  PointCloud cloud = scan.cloud;
  const GraphPose world_from_scan = graph_pose(scan.world_from_scan);
  for (Eigen::Vector3f& x : cloud.points) x = world_from_scan * x;
  for (Eigen::Vector3f& x : cloud.sensor_origin) x = world_from_scan * x;
  return cloud;
}

}  // namespace facula
