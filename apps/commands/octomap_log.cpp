// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/whole_file.hpp>
#include <facula/apps/commands/octomap_log.hpp>
#include <facula/map/scan_graph.hpp>

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

PointCloud in_world(const PosedCloud& scan) {
  if (!is_octomap_log(scan.file)) return transformed(scan.cloud, scan.world_from_scan);
  PointCloud cloud = scan.cloud;
  const GraphPose world_from_scan = graph_pose(scan.world_from_scan);
  for (Eigen::Vector3f& x : cloud.points) x = world_from_scan * x;
  for (Eigen::Vector3f& x : cloud.sensor_origin) x = world_from_scan * x;
  return cloud;
}

}  // namespace facula
