// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/random.hpp>
#include <facula/acquire/core/whole_file.hpp>
#include <facula/acquire/log/stripe_log_reader.hpp>
#include <facula/tests/apps/cli/program_run.hpp>
#include <facula/tests/support/temporary_folder.hpp>

#include <chrono>
#include <sstream>

#include <gtest/gtest.h>

namespace facula {
namespace {

constexpr int kKills = 100;

double seconds_of(const std::string& line, const std::filesystem::path& folder) {
  const auto start = std::chrono::steady_clock::now();
  EXPECT_EQ(run_line(line, folder).code, 0) << line;
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
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

/// SIGKILL at a moment that is uniform over the run's length, then --resume, a hundred times. No
/// record that was there is ever lost, at most the one being written is torn, and every scan that
/// comes to its end is, byte for byte, the one of an undisturbed run.
TEST(LogKill, LosesAtMostTheFrameInFlightAndGivesTheSameScanInTheEnd) {
  const TemporaryFolder folder;
  const ProgramRun made = run_line(
      "facula simulate data/scenes/furnished_room.toml --rig data/rigs/head_fs1500.toml "
      "--position-mm -1500 -300 1100 --from-deg 0 --to-deg 23 --step-deg 1 --out room",
      folder.path());
  ASSERT_EQ(made.code, 0) << made.err;
  const double length =
      seconds_of("facula extract room --log whole.flog --out whole.pcd", folder.path());
  const std::string whole = read_whole_file(folder / "whole.pcd");
  const std::uint64_t record = std::filesystem::file_size(folder / "whole.flog") / 24;

  Random random(11, 0);
  LogState before;
  int kills = 0;
  int finished = 0;
  while (kills < kKills) {
    std::ostringstream line;
    line << "timeout -s KILL " << random.uniform() * length
         << " facula extract room --log scan.flog --resume --out scan.pcd";
    const ProgramRun run = run_line(line.str(), folder.path());
    const LogState after = state_of(folder / "scan.flog");
    EXPECT_GE(after.records, before.records);
    EXPECT_LE(after.torn, record + record / 2);
    before = after;
    if (run.code != 0) {
      EXPECT_EQ(run.code, 137) << run.err;
      ++kills;
      if (kills < kKills) continue;
      ASSERT_EQ(
          run_line("facula extract room --log scan.flog --resume --out scan.pcd", folder.path())
              .code,
          0);
    }
    ++finished;
    EXPECT_TRUE(read_whole_file(folder / "scan.pcd") == whole) << "after " << kills << " kills";
    EXPECT_EQ(state_of(folder / "scan.flog").records, 24U);
    std::filesystem::remove(folder / "scan.flog");
    std::filesystem::remove(folder / "scan.pcd");
    before = {};
  }
  RecordProperty("finished", finished);
  EXPECT_GT(finished, 1);
}

}  // namespace
}  // namespace facula
