// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <fstream>
#include <ostream>

namespace facula {

/// A file that appears whole or not at all: it is written beside its final name, synced, and
/// renamed by commit(). Without commit() the destructor removes what was written.
class AtomicFile {
 public:
  /// Follows a symbolic link to what it names. Throws Error when the folder is missing or cannot be
  /// written, and for a folder, device or pipe of that name.
  explicit AtomicFile(const std::filesystem::path& path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// Binary stream of the new contents.
  std::ostream& stream() { return stream_; }

  /// The temporary file, for libraries that want to open it by name themselves.
  const std::filesystem::path& temporary_path() const { return temporary_; }

  /// Syncs and renames. Throws Error (and leaves the old file as it was) when any write failed,
  /// for instance because the disk is full.
  void commit();

 private:
  std::filesystem::path path_;
  std::filesystem::path temporary_;
  std::ofstream stream_;
  bool committed_ = false;
};

}  // namespace facula
