// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/whole_file.hpp>
#include <facula/apps/cli/output_path.hpp>

#include <algorithm>
#include <system_error>
#include <utility>

#include <unistd.h>

namespace facula {
namespace {

namespace fs = std::filesystem;

fs::path folder_of(const fs::path& path) {
  return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

std::string joined(const std::vector<std::string>& words) {
  std::string all;
  for (const std::string& word : words) all += (all.empty() ? "" : ", ") + word;
  return all;
}

void check_folder(const fs::path& folder, const fs::path& path) {
  std::error_code unknown;
  require(fs::is_directory(folder, unknown),
          "expected a folder to write '",
          path.string(),
          "' into, got none at '",
          folder.string(),
          "'; make it first");
  require(access(folder.c_str(), W_OK | X_OK) == 0,
          "expected to be allowed to write '",
          path.string(),
          "', got no permission for '",
          folder.string(),
          "'; choose another folder");
}

}  // namespace

void check_output(const fs::path& path, const std::vector<std::string>& extensions) {
  std::error_code unknown;
  const std::string extension = lower_extension(path);
  require(extensions.empty() ||
              std::find(extensions.begin(), extensions.end(), extension) != extensions.end(),
          "expected an output file that ends in ",
          joined(extensions),
          ", got '",
          path.string(),
          "'; change its extension");
  require(!fs::is_directory(path, unknown),
          "expected a file name to write, got the folder '",
          path.string(),
          "'; add a file name");
  require(!fs::exists(path, unknown) || fs::is_regular_file(path, unknown),
          "expected a file name to write, got the device or pipe '",
          path.string(),
          "'; choose a file name");
  check_folder(folder_of(path), path);
}

OutputFolder::OutputFolder(fs::path path, const std::string& mark, bool replace)
    : path_(std::move(path)) {
  if (!path_.has_filename()) path_ = path_.parent_path();
  std::error_code unknown;
  const bool taken = fs::exists(path_, unknown) &&
                     !(fs::is_directory(path_, unknown) && fs::is_empty(path_, unknown));
  require(!fs::exists(path_, unknown) || fs::is_directory(path_, unknown),
          "expected a new or empty folder to write, got the file '",
          path_.string(),
          "'; choose another name");
  const bool replaceable = replace && fs::exists(path_ / mark, unknown);
  require(!taken || replaceable,
          "expected a new or empty folder to write, got '",
          path_.string(),
          "' which holds something",
          replace ? " else" : "",
          "; choose another name",
          replace ? "" : " or say --overwrite");
  check_folder(folder_of(path_), path_);
  temporary_ =
      folder_of(path_) / ("." + path_.filename().string() + ".part-" + std::to_string(getpid()));
  fs::create_directory(temporary_);
}

OutputFolder::~OutputFolder() {
  std::error_code ignored;
  if (!temporary_.empty()) fs::remove_all(temporary_, ignored);
}

void OutputFolder::commit() {
  const fs::path old = temporary_.string() + "-old";
  std::error_code none;
  const bool existed = fs::exists(path_, none);
  if (existed) fs::rename(path_, old);
  fs::rename(temporary_, path_);
  temporary_.clear();
  if (existed) fs::remove_all(old);
}

}  // namespace facula
