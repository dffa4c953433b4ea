// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/atomic_file.hpp>
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/log/log_record.hpp>
#include <facula/acquire/log/stripe_log_writer.hpp>

#include <cerrno>
#include <cstring>
#include <utility>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

namespace facula {
namespace {

/// Whether all of it was written; a signal may interrupt.
bool write_all(int file, ByteView bytes) {
  while (!bytes.empty()) {
    const ssize_t written = write(file, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
  return true;
}

/// Keeps other programs from beginning a log in the same folder: two that both find no file of
/// that name would else put theirs there one after the other, and the first would write on into a
/// file that no longer has a name. Where a file system has no such locks, nothing is kept.
class FolderLock {
 public:
  explicit FolderLock(const std::filesystem::path& file) {
    const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
    folder_ = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    while (folder_ >= 0 && flock(folder_, LOCK_EX) != 0 && errno == EINTR) {
    }
  }
  ~FolderLock() {
    if (folder_ >= 0) close(folder_);
  }
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int folder_ = -1;
};

}  // namespace

StripeLogWriter::StripeLogWriter(std::filesystem::path path,
                                 std::uint64_t keep,
                                 std::uint64_t expected)
    : path_(std::move(path)), bytes_(keep) {
  file_ = open(path_.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC);
  require(file_ >= 0,
          "cannot append to the stripe log '",
          path_.string(),
          "': ",
          std::strerror(errno),
          "; check that it may be written");
  struct stat now {};
  const bool alone = flock(file_, LOCK_EX | LOCK_NB) == 0 && fstat(file_, &now) == 0 &&
                     static_cast<std::uint64_t>(now.st_size) == expected;
  if (!alone) {
    close(std::exchange(file_, -1));
    fail("the stripe log '",
         path_.string(),
         "' is being written by another program; wait until that has ended");
  }
  if (ftruncate(file_, static_cast<off_t>(keep)) != 0 || fdatasync(file_) != 0) {
    const std::string reason = std::strerror(errno);
    close(std::exchange(file_, -1));
    fail("cannot cut the torn end off the stripe log '", path_.string(), "': ", reason);
  }
}

StripeLogWriter::StripeLogWriter(StripeLogWriter&& other) noexcept
    : path_(std::move(other.path_)), file_(std::exchange(other.file_, -1)), bytes_(other.bytes_) {}

StripeLogWriter::~StripeLogWriter() {
  if (file_ >= 0) close(file_);
}

StripeLogWriter StripeLogWriter::create(const std::filesystem::path& path,
                                        const StripeLogHeader& header,
                                        ImageView8 common_background) {
  const FolderLock alone(path);
  std::error_code unknown;
  require(!std::filesystem::exists(path, unknown),
          "there is already a file '",
          path.string(),
          "', which may hold a recording; continue it with --resume, or choose another name");
  Bytes start = encode_header(header);
  if (header.background == LoggedBackground::kCommon) {
    const Bytes record = encode_background(common_background);
    start.insert(start.end(), record.begin(), record.end());
  }
  AtomicFile file(path);
  file.stream().write(reinterpret_cast<const char*>(start.data()),
                      static_cast<std::streamsize>(start.size()));
  file.commit();
  return {path, start.size(), start.size()};
}

StripeLogWriter StripeLogWriter::resume(const std::filesystem::path& path,
                                        std::uint64_t sound_bytes,
                                        std::uint64_t read_bytes) {
  return {path, sound_bytes, read_bytes};
}

void StripeLogWriter::append(const Bytes& record) {
  const std::lock_guard lock(mutex_);
  errno = 0;
  if (write_all(file_, record) && fdatasync(file_) == 0) {
    bytes_ += record.size();
    return;
  }
  const std::string reason = errno != 0 ? std::strerror(errno) : "only a part could be written";
  // What is left of the record would be recognised as torn, so that failing here loses nothing.
  const bool cut = ftruncate(file_, static_cast<off_t>(bytes_)) == 0;
  fail("cannot append to the stripe log '",
       path_.string(),
       "': ",
       reason,
       "; free some space and go on with --resume (all frames before are safe",
       cut ? ")" : ", a torn one is at the end)");
}

}  // namespace facula
