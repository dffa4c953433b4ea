// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/version.hpp>
#include <facula/apps/commands/commands.hpp>
#include <facula/tests/apps/cli/program_run.hpp>
#include <facula/tests/support/temporary_folder.hpp>

#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace facula {
namespace {

class Usage : public testing::Test {
 protected:
  ProgramRun run(const std::string& line) const { return run_line(line, folder_.path()); }
  TemporaryFolder folder_;
};

void expect_usage_error(const ProgramRun& run, const std::string& words) {
  expect_refused(run, 2, words);
}

TEST_F(Usage, HelpOfEveryCommandShowsAnExample) {
  for (const std::string& name : command_names()) {
    const ProgramRun help = run("facula " + name + " --help");
    EXPECT_EQ(help.code, 0) << name;
    EXPECT_EQ(help.err, "") << name;
    EXPECT_FALSE(examples_of(help.out).empty()) << name;
    for (const char* option : {"--json", "--threads", "--help"}) {
      EXPECT_NE(help.out.find(option), std::string::npos) << name;
    }
  }
}

TEST_F(Usage, HelpFitsInTheWidthOfAScreenButForExamples) {
  for (const std::string& name : command_names()) {
    const std::string help = run("facula " + name + " --help").out;
    const std::string before_examples = help.substr(0, help.find("\nExamples"));
    std::size_t begin = 0;
    while (begin < before_examples.size()) {
      const std::size_t end = std::min(before_examples.find('\n', begin), before_examples.size());
      EXPECT_LE(end - begin, 100U) << before_examples.substr(begin, end - begin);
      begin = end + 1;
    }
  }
}

TEST_F(Usage, ProgramAloneListsEveryCommand) {
  EXPECT_EQ(run("facula").code, 0);
  std::vector<std::string> expected;
  for (const Command& command : all_commands()) expected.push_back(command.name);
  EXPECT_EQ(command_names(), expected);
}

TEST_F(Usage, VersionIsTheLibrarys) {
  const ProgramRun version = run("facula --version");
  EXPECT_EQ(version.code, 0);
  EXPECT_EQ(version.out, std::string("facula ") + facula::version() + "\n");
}

TEST_F(Usage, UnknownCommandSuggestsTheNearOne) {
  expect_usage_error(run("facula extrct capture"), "did you mean 'extract'?");
  expect_usage_error(run("facula measure plane x.pcd"), "facula measure planes");
  expect_usage_error(run("facula calibrate camra x.png"), "facula calibrate camera");
  expect_usage_error(run("facula calibrate everything"), "'facula calibrate' alone lists it");
  expect_usage_error(run("facula xyzzy"), "expected a command, got 'xyzzy'");
}

TEST_F(Usage, UnknownOptionSuggestsTheNearOne) {
  expect_usage_error(run("facula extract capture --ot scan.pcd"), "did you mean '--out'?");
  expect_usage_error(run("facula map s.pcd --out m.bt --resolution-m 5"),
                     "did you mean '--resolution-mm'?");
}

TEST_F(Usage, MalformedValuesSayWhatWasExpected) {
  expect_usage_error(run("facula map s.pcd --out m.bt --resolution-mm five"),
                     "--resolution-mm: expected a number in mm, got 'five'");
  expect_usage_error(run("facula map s.pcd --out m.bt --resolution-mm nan"), "got 'nan'");
  expect_usage_error(run("facula map s.pcd --out m.bt --threads -3"), "--threads");
  expect_usage_error(run("facula mesh s.pcd --out m.ply --method advancing-frnt"),
                     "did you mean 'advancing-front'?");
  expect_usage_error(run("facula mesh s.pcd --out m.ply --threads 99999"), "--threads");
}

TEST_F(Usage, VectorsAreThreeWordsOrOneWithCommas) {
  const std::string missing = "none.pcd";  // what the command says once it has read the words
  const std::string line = "facula measure profile none.pcd --at-mm ";
  for (const char* typed : {"-1 2.5 3", "-1,2.5,3"}) {
    expect_refused(run(line + typed), 1, missing);
  }
  expect_refused(run("facula measure profile none.pcd --at-mm=-1,2.5,3"), 1, missing);
  expect_usage_error(run(line + "1,2"), "--at-mm: expected three numbers, got 1");
  expect_usage_error(run(line + "1,,3"), "--at-mm: expected a number in mm, got ''");
  expect_usage_error(run(line + "1,2,3,4"), "--at-mm");
}

TEST_F(Usage, SentencesDoNotNameTypesOfTheLibrary) {
  EXPECT_EQ(run("facula map s.pcd --out m.bt --resolution-mm 0").err,
            "facula map: expected a resolution above 0 m, got 0\n");
}

TEST_F(Usage, MissingArgumentsAreNamed) {
  expect_usage_error(run("facula extract capture"), "--out");
  expect_usage_error(run("facula extract --out scan.pcd"), "CAPTURE");
  expect_usage_error(run("facula extract capture --out"), "--out");
  expect_usage_error(run("facula info one.pcd two.pcd"), "expected one FILE, got more");
}

TEST_F(Usage, EmptyPathsAreNamed) {
  expect_usage_error(run("facula info data/rigs/head_fs1500.toml --json ''"), "--json");
  expect_usage_error(run("facula info ''"), "FILE");
  expect_usage_error(run("facula mesh a.pcd --out ''"), "--out");
}

TEST_F(Usage, FirstWordOfSeveralCommandsListsThem) {
  for (const char* line :
       {"facula calibrate", "facula calibrate --help", "facula help calibrate"}) {
    const ProgramRun list = run(line);
    EXPECT_EQ(list.code, 0) << list.err;
    for (const std::string& name : command_names()) {
      const bool expected = name.starts_with("calibrate ");
      EXPECT_EQ(list.out.find("  " + name + " ") != std::string::npos, expected) << line << name;
    }
  }
}

TEST_F(Usage, HelpBeforeTheCommandIsHelpAfterIt) {
  const ProgramRun before = run("facula help calibrate camera");
  EXPECT_EQ(before.code, 0) << before.err;
  EXPECT_EQ(before.out, run("facula calibrate camera --help").out);
}

TEST_F(Usage, MissingFileIsOneSentence) {
  for (const char* line : {"facula info nothing.pcd",
                           "facula extract nothing --out s.pcd",
                           "facula mesh nothing.pcd --out m.ply",
                           "facula simulate nothing.toml --rig data/rigs/head_fs1500.toml --out c",
                           "facula map nothing.pcd --out m.bt",
                           "facula register a.pcd b.pcd --out p.toml"}) {
    const ProgramRun missing = run(line);
    EXPECT_EQ(missing.code, 1) << line;
    EXPECT_EQ(missing.err.rfind("facula ", 0), 0U) << missing.err;
    EXPECT_EQ(std::count(missing.err.begin(), missing.err.end(), '\n'), 1) << missing.err;
  }
}

}  // namespace
}  // namespace facula
