// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/reconstruct/register/scan_project.hpp>

#include <filesystem>

namespace facula {

// The readers behind read_scan_project(), one per format described there.

ScanProject read_poses_file(const std::filesystem::path& path);
ScanProject read_stanford_conf(const std::filesystem::path& path);
ScanProject read_3dtk_folder(const std::filesystem::path& folder);
ScanProject read_3dtk_scan(const std::filesystem::path& file);

/// One scan with the pose of its file (VIEWPOINT of a .pcd, else the identity); may be packed.
/// Points without sensor origins get the frame's origin.
PosedCloud read_scan_file(const std::filesystem::path& path);

}  // namespace facula
