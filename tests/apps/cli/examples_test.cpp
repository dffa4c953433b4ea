// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/tests/apps/cli/program_run.hpp>
#include <facula/tests/support/temporary_folder.hpp>

#include <string>

#include <gtest/gtest.h>

namespace facula {
namespace {

class Examples : public testing::TestWithParam<std::string> {};

/// The lines of --help, one after the other in an empty folder, as a reader would type them.
TEST_P(Examples, OfTheHelpRunAndAreQuietWithoutTerminal) {
  const TemporaryFolder folder;
  const std::string help = run_line("facula " + GetParam() + " --help", folder.path()).out;
  const auto examples = examples_of(help);
  ASSERT_FALSE(examples.empty());
  bool own = false;
  for (const std::string& line : examples) {
    const ProgramRun run = run_line(line, folder.path());
    ASSERT_EQ(run.code, 0) << line << '\n' << run.err;
    EXPECT_EQ(run.err, "") << line;
    EXPECT_NE(run.out, "") << line;
    own = own || line.starts_with("facula " + GetParam() + " ");
  }
  EXPECT_TRUE(own) << "no example of the command itself";
  EXPECT_FALSE(has_file_like(folder.path(), ".part")) << "a temporary file was left behind";
}

std::string test_name(const testing::TestParamInfo<std::string>& info) {
  std::string name = info.param;
  for (char& letter : name) letter = letter == ' ' || letter == '-' ? '_' : letter;
  return name;
}

INSTANTIATE_TEST_SUITE_P(Command, Examples, testing::ValuesIn(command_names()), test_name);

}  // namespace
}  // namespace facula
