// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/random.hpp>
#include <facula/acquire/core/whole_file.hpp>
#include <facula/acquire/log/stripe_log_reader.hpp>
#include <facula/apps/cli/program.hpp>
#include <facula/apps/commands/commands.hpp>
#include <facula/tests/apps/cli/program_run.hpp>
#include <facula/tests/support/temporary_folder.hpp>

#include <chrono>
#include <csignal>
#include <cstdio>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

namespace facula {
namespace {

constexpr int kKills = 100;
using Seconds = std::chrono::duration<double>;

/// The program in a process of its own, without the time that loading its libraries takes: a kill
/// during that would try nothing.
pid_t started(const std::vector<std::string>& words, const std::filesystem::path& folder) {
  const pid_t child = fork();
  if (child != 0) return child;
  const bool ready = chdir(folder.c_str()) == 0 &&
                     std::freopen("/dev/null", "w", stdout) != nullptr &&
                     std::freopen("/dev/null", "w", stderr) != nullptr;
  _exit(ready ? run_program(words, all_commands()) : 3);
}

/// How it ended, as a shell says it: 128 and the signal where one ended it.
int exit_code_of(pid_t child) {
  int status = 0;
  EXPECT_EQ(waitpid(child, &status, 0), child);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

struct LogState {
  std::size_t records = 0;
  std::uint64_t torn = 0;
};

/// Every record behind its head must be sound too.
LogState state_of(const std::filesystem::path& path) {
  LogState state;
  if (!std::filesystem::exists(path)) return state;
  const StripeLogReader log(path);
  EXPECT_EQ(log.damage().dropped_records, 0U);
  for (std::size_t i = 0; i < log.size(); ++i) EXPECT_TRUE(log.read(i).has_value());
  state.records = log.size();
  state.torn = log.damage().torn_bytes;
  return state;
}

class LogKill : public testing::Test {
 protected:
  void SetUp() override {
    const ProgramRun made = run_line(
        "facula simulate data/scenes/furnished_room.toml --rig data/rigs/head_fs1500.toml "
        "--position-mm -1500 -300 1100 --from-deg 0 --to-deg 23 --step-deg 1 --out room",
        folder_.path());
    ASSERT_EQ(made.code, 0) << made.err;
    const auto start = std::chrono::steady_clock::now();
    ASSERT_EQ(exit_code_of(started({"extract", "room", "--log", "whole.flog", "--out", "whole.pcd"},
                                   folder_.path())),
              0);
    length_ = std::chrono::steady_clock::now() - start;
    whole_ = read_whole_file(folder_ / "whole.pcd");
    record_ = std::filesystem::file_size(folder_ / "whole.flog") / 24;
  }

  pid_t resumed() const {
    return started({"extract", "room", "--log", "scan.flog", "--resume", "--out", "scan.pcd"},
                   folder_.path());
  }

  TemporaryFolder folder_;
  Seconds length_{0};
  std::string whole_;
  std::uint64_t record_ = 0;  ///< mean size [byte]
};

/// SIGKILL at a moment that is uniform over the run's length, then --resume, a hundred times. No
/// record that was there is ever lost, at most the one being written is torn, and every scan that
/// comes to its end is, byte for byte, the one of an undisturbed run.
TEST_F(LogKill, LosesAtMostTheFrameInFlightAndGivesTheSameScanInTheEnd) {
  Random random(11, 0);
  LogState before;
  int kills = 0;
  int finished = 0;
  while (kills < kKills) {
    const pid_t child = resumed();
    std::this_thread::sleep_for(random.uniform() * length_);
    kill(child, SIGKILL);
    const int code = exit_code_of(child);
    const LogState after = state_of(folder_ / "scan.flog");
    EXPECT_GE(after.records, before.records);
    EXPECT_LE(after.torn, record_ + record_ / 2);
    before = after;
    if (code != 0) {
      EXPECT_EQ(code, 128 + SIGKILL);
      ++kills;
      if (kills < kKills) continue;
      ASSERT_EQ(exit_code_of(resumed()), 0);
    }
    ++finished;
    EXPECT_TRUE(read_whole_file(folder_ / "scan.pcd") == whole_) << "after " << kills << " kills";
    EXPECT_EQ(state_of(folder_ / "scan.flog").records, 24U);
    std::filesystem::remove(folder_ / "scan.flog");
    std::filesystem::remove(folder_ / "scan.pcd");
    before = {};
  }
  RecordProperty("finished", finished);
  EXPECT_GT(finished, 1);
}

}  // namespace
}  // namespace facula
