// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/apps/cli/data_folder.hpp>

#include <cstdlib>
#include <system_error>

namespace facula {
namespace {

namespace fs = std::filesystem;

fs::path installed_data() {
  std::error_code unknown;
  const fs::path program = fs::read_symlink("/proc/self/exe", unknown);
  if (unknown) return {};
  return program.parent_path().parent_path() / "share" / "facula";
}

bool is_folder(const fs::path& path) {
  std::error_code unknown;
  return !path.empty() && fs::is_directory(path, unknown);
}

}  // namespace

fs::path data_folder() {
  const char* chosen = std::getenv("FACULA_DATA");
  if (chosen != nullptr && *chosen != 0) return chosen;
  fs::path installed = installed_data();
  if (is_folder(installed)) return installed;
  return FACULA_SOURCE_DATA;
}

fs::path resolved_input(const std::string& typed) {
  std::error_code unknown;
  const std::string prefix = "data/";
  if (fs::exists(typed, unknown) || !typed.starts_with(prefix)) return typed;
  const fs::path shipped = data_folder() / typed.substr(prefix.size());
  return fs::exists(shipped, unknown) ? shipped : fs::path(typed);
}

}  // namespace facula
