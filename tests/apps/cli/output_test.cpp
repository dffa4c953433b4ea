// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/text_numbers.hpp>
#include <facula/apps/cli/number_text.hpp>
#include <facula/tests/apps/cli/program_run.hpp>
#include <facula/tests/support/temporary_folder.hpp>

#include <cstdio>
#include <set>
#include <sstream>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace facula {
namespace {

/// Every number in a JSON value, written with 0 to 6 decimals, and the words of its texts.
void collect(const nlohmann::json& value, std::set<std::string>& texts) {
  if (value.is_structured()) {
    for (const auto& part : value) collect(part, texts);
  } else if (value.is_string()) {
    std::istringstream words(value.get<std::string>());
    for (std::string word; words >> word;) texts.insert(word);
  } else if (value.is_number()) {
    for (int decimals = 0; decimals <= 6; ++decimals) {
      texts.insert(fixed_text(value.get<double>(), decimals));
    }
  }
}

/// Headings hold no figures; they begin at the left edge.
std::string figure_lines(const std::string& text) {
  std::istringstream lines(text);
  std::string figures;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("  ")) figures += line + '\n';
  }
  return figures;
}

class Output : public testing::Test {
 protected:
  void SetUp() override {
    make_small_capture(folder_.path());
    ASSERT_EQ(run_line("facula extract capture --out scan.pcd", folder_.path()).code, 0);
  }
  ProgramRun run(const std::string& line) const { return run_line(line, folder_.path()); }

  /// Runs the line for people and for programs; nothing may differ but the form.
  void expect_same_figures(const std::string& line) const {
    const ProgramRun people = run(line);
    const ProgramRun programs = run(line + " --json -");
    ASSERT_EQ(people.code, 0) << people.err;
    ASSERT_EQ(programs.code, 0) << programs.err;
    ASSERT_TRUE(nlohmann::json::accept(programs.out)) << programs.out;
    std::set<std::string> known;
    collect(nlohmann::json::parse(programs.out), known);
    std::istringstream words(figure_lines(people.out));
    int numbers = 0;
    for (std::string word; words >> word;) {
      if (!parse_number<double>(word)) continue;
      ++numbers;
      EXPECT_TRUE(known.contains(word)) << word << " is printed but not in the JSON of " << line;
    }
    EXPECT_GT(numbers, 2) << people.out;
  }

  TemporaryFolder folder_;
};

TEST_F(Output, AScanDoesNotReplaceTheLogOfItsRecording) {
  for (const char* name : {"both.pcd", "./both.pcd", "capture/../both.pcd"}) {
    const ProgramRun refused =
        run("facula extract capture --log both.pcd --out " + std::string(name));
    EXPECT_EQ(refused.code, 1);
    EXPECT_NE(refused.err.find("give the log another name"), std::string::npos) << refused.err;
    EXPECT_FALSE(has_file_like(folder_.path(), "both"));
  }
}

TEST_F(Output, JsonHoldsEveryFigurePrinted) {
  expect_same_figures("facula extract capture --out again.pcd");
  expect_same_figures("facula info scan.pcd");
  expect_same_figures("facula info capture");
  expect_same_figures("facula map scan.pcd --out map.bt --grid map.yaml");
  expect_same_figures("facula mesh scan.pcd --out mesh.ply --method grid --max-edge-mm 300");
  expect_same_figures(
      "facula measure planes scan.pcd --inlier-mm 30 --min-points 100 --voxel-mm 40");
}

TEST_F(Output, JsonFileLeavesStandardOutputToPeople) {
  const ProgramRun both = run("facula info scan.pcd --json info.json");
  EXPECT_EQ(both.code, 0);
  EXPECT_NE(both.out.find("points"), std::string::npos);
  const ProgramRun file = run("cat info.json");
  EXPECT_EQ(nlohmann::json::parse(file.out)["kind"], "scan");
}

TEST_F(Output, ThreadsDoNotChangeResults) {
  ASSERT_EQ(run("facula extract capture --out one.pcd --threads 1").code, 0);
  ASSERT_EQ(run("facula extract capture --out four.pcd --threads 4").code, 0);
  EXPECT_EQ(run("cmp one.pcd four.pcd").code, 0);
}

TEST_F(Output, FullStandardOutputIsAFailure) {
  const ProgramRun full = run("facula info scan.pcd >/dev/full");
  EXPECT_EQ(full.code, 1);
  EXPECT_NE(full.err.find("standard output"), std::string::npos) << full.err;
}

TEST_F(Output, ExistingCaptureIsNotOverwrittenUnasked) {
  const std::string line =
      "facula simulate data/scenes/flat_wall.toml --rig data/rigs/head_fs1500.toml --to-deg 2 "
      "--out capture";
  const ProgramRun refused = run(line);
  EXPECT_EQ(refused.code, 1);
  EXPECT_NE(refused.err.find("--overwrite"), std::string::npos) << refused.err;
  EXPECT_EQ(run(line + " --overwrite").code, 0);
}

TEST_F(Output, TerminalSeesProgressWithTimeLeft) {
  if (run("command -v script").code != 0) GTEST_SKIP() << "the program script is not installed";
  const ProgramRun shown =
      run("script -qec 'facula simulate data/scenes/furnished_room.toml --rig "
          "data/rigs/head_fs1500.toml --position-mm -1500 -300 1100 --step-deg 2 --threads 1 --out "
          "long' /dev/null");
  EXPECT_EQ(shown.code, 0) << shown.out;
  EXPECT_NE(shown.out.find("simulating frames ["), std::string::npos) << shown.out;
  EXPECT_NE(shown.out.find("ETA"), std::string::npos) << shown.out;
}

TEST_F(Output, ShippedDataAreFoundThroughTheEnvironment) {
  ASSERT_EQ(run("mkdir -p own/rigs && cp capture/rig.toml own/rigs/mine.toml").code, 0);
  EXPECT_EQ(run("FACULA_DATA=own facula info data/rigs/mine.toml").code, 0);
  EXPECT_EQ(run("facula info data/rigs/mine.toml").code, 1);
}

}  // namespace
}  // namespace facula
