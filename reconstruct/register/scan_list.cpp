// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/whole_file.hpp>
#include <facula/reconstruct/register/compressed_file.hpp>
#include <facula/reconstruct/register/scan_list.hpp>
#include <facula/reconstruct/register/scan_project_formats.hpp>

namespace facula {

std::vector<ListedScan> list_scans(const std::filesystem::path& path) {
  require(std::filesystem::exists(path),
          "there is no file or folder '",
          path.string(),
          "'; give a poses.toml, a .conf, a folder of 3DTK scans, or a scan file");
  if (std::filesystem::is_directory(path)) {
    const auto poses = path / "poses.toml";
    return std::filesystem::exists(poses) ? list_poses_file(poses) : list_3dtk_folder(path);
  }
  const std::string extension = lower_extension(path);
  if (extension == ".toml") return list_poses_file(path);
  if (extension == ".conf") return list_stanford_conf(path);
  if (without_packing(path).extension() == ".3d") return {list_3dtk_scan(path)};
  return {{.name = without_packing(path).stem().string(), .file = path, .read = [path] {
             return read_scan_file(path);
           }}};
}

}  // namespace facula
