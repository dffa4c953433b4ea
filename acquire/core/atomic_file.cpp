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

/// A hidden name beside `path` that keeps its extension, since some libraries go by it.
std::filesystem::path name_beside(const std::filesystem::path& path) {
  static std::atomic<unsigned> counter{0};
  const std::string name = "." + path.stem().string() + "." + std::to_string(getpid()) + "-" +
                           std::to_string(counter++) + ".tmp" + path.extension().string();
  return path.parent_path() / name;
}

std::string reason() {
  return errno != 0 ? std::strerror(errno) : "unknown reason";
}

bool sync_to_disk(const std::filesystem::path& path, int flags) {
  const int descriptor = open(path.c_str(), flags | O_CLOEXEC);
  if (descriptor < 0) return false;
  const bool synced = fsync(descriptor) == 0;
  close(descriptor);
  return synced;
}

}  // namespace

AtomicFile::AtomicFile(std::filesystem::path path)
    : path_(std::move(path)), temporary_(name_beside(path_)) {
  require(!std::filesystem::is_directory(path_),
          "cannot write '",
          path_.string(),
          "': there is a folder of that name");
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
