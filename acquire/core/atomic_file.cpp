// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/atomic_file.hpp>
#include <facula/acquire/core/error.hpp>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <string>

#include <fcntl.h>
#include <unistd.h>

namespace facula {
namespace {

/// Where a symbolic link leads: renaming onto the link itself would replace it.
std::filesystem::path followed(const std::filesystem::path& path) {
  std::error_code failure;
  if (!std::filesystem::is_symlink(path, failure)) return path;
  const std::filesystem::path target = std::filesystem::weakly_canonical(path, failure);
  return failure || target.empty() ? path : target;
}

/// A hidden name beside `path` with the extension as asked for, since some libraries go by it.
std::filesystem::path name_beside(const std::filesystem::path& path,
                                  const std::filesystem::path& extension) {
  static std::atomic<unsigned> counter{0};
  const std::string name = "." + path.stem().string() + "." + std::to_string(getpid()) + "-" +
                           std::to_string(counter++) + ".tmp" + extension.string();
  return path.parent_path() / name;
}

std::string reason() {
  // A write that failed before left no reason behind; a full disk is the usual one.
  return errno != 0 ? std::strerror(errno) : "a part of it could not be written";
}

bool sync_to_disk(const std::filesystem::path& path, int flags) {
  const int descriptor = open(path.c_str(), flags | O_CLOEXEC);
  if (descriptor < 0) return false;
  const bool synced = fsync(descriptor) == 0;
  close(descriptor);
  return synced;
}

}  // namespace

AtomicFile::AtomicFile(const std::filesystem::path& path)
    : path_(followed(path)), temporary_(name_beside(path_, path.extension())) {
  require(!std::filesystem::is_directory(path_),
          "cannot write '",
          path_.string(),
          "': there is a folder of that name");
  std::error_code unknown;
  require(
      !std::filesystem::exists(path_, unknown) || std::filesystem::is_regular_file(path_, unknown),
      "cannot write '",
      path_.string(),
      "': it is a device or a pipe, which a file would replace; choose a file name");
  errno = 0;
  stream_.open(temporary_, std::ios::binary | std::ios::trunc);
  require(stream_.is_open(),
          "cannot write '",
          path_.string(),
          "': ",
          reason(),
          "; choose a folder that exists and may be written");
}

AtomicFile::~AtomicFile() {
  if (committed_) return;
  stream_.close();
  std::error_code ignored;
  std::filesystem::remove(temporary_, ignored);
}

void AtomicFile::commit() {
  errno = 0;
  stream_.flush();
  const bool written = stream_.good();
  stream_.close();
  require(written && stream_.good() && sync_to_disk(temporary_, O_WRONLY),
          "cannot finish writing '",
          path_.string(),
          "': ",
          reason(),
          "; free some space and run again (nothing was changed under that name)");
  std::error_code failure;
  std::filesystem::rename(temporary_, path_, failure);
  require(
      !failure, "cannot rename the finished file to '", path_.string(), "': ", failure.message());
  committed_ = true;
  const auto folder = path_.parent_path();
  sync_to_disk(folder.empty() ? "." : folder, O_RDONLY | O_DIRECTORY);
}

}  // namespace facula
