// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/atomic_file.hpp>
#include <facula/acquire/core/cloud_file.hpp>
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/whole_file.hpp>
#include <facula/tests/support/matchers.hpp>
#include <facula/tests/support/temporary_folder.hpp>

#include <csignal>

#include <sys/resource.h>
#include <sys/stat.h>

namespace facula {
namespace {

std::size_t files_in(const std::filesystem::path& folder) {
  return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder), {}));
}

/// A disk that is full after some bytes: writes beyond the limit fail while this lives.
class FullDisk {
 public:
  explicit FullDisk(rlim_t bytes) {
    signal_ = std::signal(SIGXFSZ, SIG_IGN);
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FullDisk() {
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, signal_);
  }
  FullDisk(const FullDisk&) = delete;
  FullDisk& operator=(const FullDisk&) = delete;

 private:
  rlimit before_{};
  void (*signal_)(int) = nullptr;
};

TEST(AtomicFile, AppearsWholeWithCommitAndReplacesTheOldOne) {
  const TemporaryFolder folder;
  const auto path = folder.write("a.txt", "old");
  AtomicFile file(path);
  file.stream() << "new contents";
  EXPECT_EQ(read_whole_file(path), "old");
  file.commit();
  EXPECT_EQ(read_whole_file(path), "new contents");
  EXPECT_EQ(files_in(folder.path()), 1U);
}

TEST(AtomicFile, LeavesNothingBehindWithoutCommit) {
  const TemporaryFolder folder;
  {
    AtomicFile file(folder / "a.txt");
    file.stream() << "half";
    EXPECT_EQ(files_in(folder.path()), 1U);
  }
  EXPECT_EQ(files_in(folder.path()), 0U);
}

TEST(AtomicFile, KeepsTheExtensionForTheTemporaryName) {
  const TemporaryFolder folder;
  const AtomicFile file(folder / "map.ot");
  EXPECT_EQ(file.temporary_path().extension(), ".ot");
  EXPECT_EQ(file.temporary_path().parent_path(), folder.path());
}

TEST(AtomicFile, NamesAMissingFolder) {
  const TemporaryFolder folder;
  const std::string sentence = error_of([&] { AtomicFile(folder / "none" / "a.txt"); });
  EXPECT_NE(sentence.find("none/a.txt"), std::string::npos);
  EXPECT_NE(sentence.find("choose a folder that exists"), std::string::npos);
}

TEST(AtomicFile, RefusesTheNameOfAFolder) {
  const TemporaryFolder folder;
  EXPECT_THROW(AtomicFile{folder.path()}, Error);
}

TEST(AtomicFile, RefusesAPipeAndLeavesIt) {
  const TemporaryFolder folder;
  const auto path = folder / "pipe";
  ASSERT_EQ(mkfifo(path.c_str(), 0600), 0);
  EXPECT_THROW(AtomicFile{path}, Error);
  EXPECT_TRUE(std::filesystem::is_fifo(path));
}

TEST(AtomicFile, WritesWhatASymbolicLinkNamesAndKeepsTheLink) {
  const TemporaryFolder folder;
  const auto target = folder.write("target", "old");
  const auto link = folder / "link.ply";
  std::filesystem::create_symlink("target", link);
  AtomicFile file(link);
  EXPECT_EQ(file.temporary_path().extension(), ".ply");
  file.stream() << "new";
  file.commit();
  EXPECT_TRUE(std::filesystem::is_symlink(link));
  EXPECT_EQ(read_whole_file(target), "new");
}

TEST(AtomicFile, KeepsTheOldFileWhenTheDiskIsFull) {
  const TemporaryFolder folder;
  const auto path = folder.write("cloud.ply", "the old file");
  PointCloud cloud;
  cloud.points.assign(100000, {1, 2, 3});
  std::string sentence;
  {
    const FullDisk full(65536);
    sentence = error_of([&] { write_cloud(path, cloud); });
  }
  EXPECT_NE(sentence.find("cannot finish writing"), std::string::npos) << sentence;
  EXPECT_EQ(read_whole_file(path), "the old file");
  EXPECT_EQ(files_in(folder.path()), 1U);
  EXPECT_NO_THROW(write_cloud(path, cloud));
}

TEST(AtomicFile, WritesNoFileUnderTheFinalNameWhenTheDiskIsFull) {
  const TemporaryFolder folder;
  {
    const FullDisk full(10);
    AtomicFile file(folder / "a.txt");
    file.stream() << "more than ten bytes";
    EXPECT_THROW(file.commit(), Error);
  }
  EXPECT_EQ(files_in(folder.path()), 0U);
}

}  // namespace
}  // namespace facula
