// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/reconstruct/filter/cloud_filters.hpp>
#include <facula/reconstruct/filter/normals.hpp>
#include <facula/reconstruct/register/register_project.hpp>

namespace facula {
namespace {

PointCloud thinned_with_normals(const PosedCloud& scan, const RegisterOptions& options) {
  require(!scan.cloud.empty(), "scan '", scan.name, "' has no points; leave it out");
  PointCloud thinned = thin_by_voxel(scan.cloud, options.voxel);
  require(thinned.size() >= 3,
          "scan '",
          scan.name,
          "' has only ",
          thinned.size(),
          " points left at a voxel of ",
          options.voxel,
          " m; choose a smaller voxel");
  estimate_normals(thinned, {.num_threads = options.icp.num_threads});
  return thinned;
}

}  // namespace

std::vector<IcpResult> register_project(ScanProject& project, const RegisterOptions& options) {
  options.icp.check();
  require(options.voxel > 0, "voxel is ", options.voxel, " m; give a length above 0");
  std::vector<IcpResult> results;
  PointCloud target;  // the scans registered so far, in the world frame
  for (std::size_t i = 0; i < project.scans.size(); ++i) {
    PosedCloud& scan = project.scans[i];
    const PointCloud source = thinned_with_normals(scan, options);
    if (i > 0) {
      results.push_back(register_icp(source, target, scan.world_from_scan, options.icp));
      scan.world_from_scan = results.back().target_from_source;
      append(target, transformed(source, scan.world_from_scan));
      target = thin_by_voxel(target, options.voxel);
    } else {
      target = transformed(source, scan.world_from_scan);
    }
    if (options.progress) options.progress(i + 1, project.scans.size());
  }
  return results;
}

}  // namespace facula
