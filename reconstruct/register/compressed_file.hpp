// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

namespace facula {

/// A file that readers can open, whatever it was packed with: NAME.gz and NAME.xz are unpacked to a
/// temporary file NAME that lives as long as this object; every other file is left where it is.
class UnpackedFile {
 public:
  /// Throws Error when the file is missing, torn, or not what its extension says.
  explicit UnpackedFile(const std::filesystem::path& path);
  ~UnpackedFile();
  UnpackedFile(const UnpackedFile&) = delete;
  UnpackedFile& operator=(const UnpackedFile&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
  std::filesystem::path temporary_folder_;  ///< empty when nothing was unpacked
};

/// `path` without .gz or .xz.
std::filesystem::path without_packing(const std::filesystem::path& path);

/// `path` itself where there is such a file, else `path`.gz or `path`.xz where there is one, else
/// `path` (whose reader then says that it is missing).
std::filesystem::path packed_or_plain(const std::filesystem::path& path);

}  // namespace facula
