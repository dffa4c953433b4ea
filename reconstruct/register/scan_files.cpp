// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/cloud_file.hpp>
#include <facula/acquire/core/pcd_header.hpp>
#include <facula/acquire/core/scan_file.hpp>
#include <facula/acquire/core/scan_header.hpp>
#include <facula/acquire/core/whole_file.hpp>
#include <facula/reconstruct/filter/grid_normals.hpp>
#include <facula/reconstruct/register/compressed_file.hpp>
#include <facula/reconstruct/register/pan_tilt_list.hpp>
#include <facula/reconstruct/register/scan_project_formats.hpp>

#include <string_view>
#include <utility>

namespace facula {
namespace {

/// An organised .pcd knows the sensor's origin per column, every .pcd a pose.
void read_pcd_scan(const std::filesystem::path& path, PosedCloud& scan) {
  const std::string bytes = read_whole_file(path);
  std::string_view text = bytes;
  const PcdTable table = take_pcd_header(text, path.string()).table;
  if (table.height > 1) {
    const PolarScan polar = read_scan(path);
    scan.cloud = cloud_from_scan(polar);
    scan.grid = grid_from_scan(polar);
    scan.world_from_scan = polar.world_from_scan;
    scan.stand = polar.stand;
  } else {
    scan.cloud = read_cloud(path);
    scan.world_from_scan = pose_of(table.viewpoint, path);
  }
}

/// A range image whose lines of sight are known tells its normals.
void orient_grid(PosedCloud& scan) {
  if (scan.grid.empty() || scan.cloud.sensor_origin.empty() || !scan.cloud.normals.empty()) return;
  scan.cloud.normals = grid_normals(scan.cloud, scan.grid);
}

}  // namespace

PosedCloud read_scan_file(const std::filesystem::path& path) {
  const UnpackedFile file(path);
  PosedCloud scan;
  scan.name = without_packing(path).stem().string();
  scan.file = path;
  if (lower_extension(file.path()) == ".pcd") {
    read_pcd_scan(file.path(), scan);
  } else if (is_pan_tilt_list(file.path())) {
    PosedCloud list = posed_cloud(read_pan_tilt_list(file.path()));
    scan.cloud = std::move(list.cloud);
    scan.grid = std::move(list.grid);
  } else {
    scan.cloud = read_cloud(file.path(), &scan.grid);
    orient_grid(scan);
  }
  if (scan.cloud.sensor_origin.empty()) {
    scan.cloud.sensor_origin.assign(scan.cloud.size(), Eigen::Vector3f::Zero());
  }
  return scan;
}

}  // namespace facula
