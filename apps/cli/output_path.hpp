// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace facula {

/// Throws Error when the file could not be written in the end: its folder is missing or closed, it
/// is a folder itself, or its extension is none of `extensions` (all are fine when empty). Called
/// before long work starts.
void check_output(const std::filesystem::path& path,
                  const std::vector<std::string>& extensions = {});

/// A folder that appears whole or not at all: it is filled beside its final name and renamed by
/// commit(); without that it is removed.
class OutputFolder {
 public:
  /// Throws Error when something is at `path` already: an empty folder may be, and a folder that
  /// holds `mark` (as an earlier run left it) when `replace`.
  OutputFolder(std::filesystem::path path, const std::string& mark, bool replace);
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  const std::filesystem::path& temporary_path() const { return temporary_; }
  void commit();

 private:
  std::filesystem::path path_;
  std::filesystem::path temporary_;
};

}  // namespace facula
