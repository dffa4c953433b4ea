// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/reconstruct/register/scan_list.hpp>

#include <filesystem>
#include <vector>

namespace facula {

// The readers behind list_scans(), one per format that read_scan_project() describes.

std::vector<ListedScan> list_poses_file(const std::filesystem::path& path);
std::vector<ListedScan> list_stanford_conf(const std::filesystem::path& path);
std::vector<ListedScan> list_3dtk_folder(const std::filesystem::path& folder);
ListedScan list_3dtk_scan(const std::filesystem::path& file);

/// One scan with the pose of its file (VIEWPOINT of a .pcd, else the identity); may be packed.
/// Points without sensor origins get the frame's origin.
PosedCloud read_scan_file(const std::filesystem::path& path);

}  // namespace facula
