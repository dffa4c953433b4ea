// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/reconstruct/register/scan_project.hpp>

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace facula {

/// A scan of a project whose file has not been opened.
struct ListedScan {
  std::string name;
  std::filesystem::path file;        ///< as the project has it, which may leave out .gz or .xz
  std::function<PosedCloud()> read;  ///< throws Error as the file readers do
};

/// What read_scan_project() would read, in its order, without opening the files of points: projects
/// that are larger than the memory are gone through scan by scan. Throws Error where the project's
/// own file is missing or wrong.
std::vector<ListedScan> list_scans(const std::filesystem::path& path);

}  // namespace facula
