// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/whole_file.hpp>
#include <facula/reconstruct/register/compressed_file.hpp>
#include <facula/reconstruct/register/scan_project.hpp>
#include <facula/reconstruct/register/scan_project_formats.hpp>

namespace facula {

PointCloud ScanProject::fused() const {
  PointCloud all;
  for (const PosedCloud& scan : scans) {
    const PointCloud moved = transformed(scan.cloud, scan.world_from_scan);
    if (all.empty()) {
      all = moved;  // append() would drop the attributes that an empty cloud lacks
    } else {
      append(all, moved);
    }
  }
  return all;
}

ScanProject read_scan_project(const std::filesystem::path& path) {
  require(std::filesystem::exists(path),
          "there is no file or folder '",
          path.string(),
          "'; give a poses.toml, a .conf, a folder of 3DTK scans, or a scan file");
  if (std::filesystem::is_directory(path)) {
    const auto poses = path / "poses.toml";
    return std::filesystem::exists(poses) ? read_poses_file(poses) : read_3dtk_folder(path);
  }
  const std::string extension = lower_extension(path);
  if (extension == ".toml") return read_poses_file(path);
  if (extension == ".conf") return read_stanford_conf(path);
  if (without_packing(path).extension() == ".3d") return read_3dtk_scan(path);
  return {{read_scan_file(path)}};
}

}  // namespace facula
