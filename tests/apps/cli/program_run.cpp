// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/tests/apps/cli/program_run.hpp>
#include <facula/tests/support/temporary_folder.hpp>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include <gtest/gtest.h>
#include <sys/wait.h>

namespace facula {
namespace {

std::string contents(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

}  // namespace

ProgramRun run_line(const std::string& line, const std::filesystem::path& folder) {
  const TemporaryFolder streams;
  const std::string program_folder = std::filesystem::path(FACULA_PROGRAM).parent_path().string();
  const std::string shell = "cd '" + folder.string() + "' && PATH='" + program_folder +
                            "':$PATH && { " + line + " ; } >'" + (streams / "out").string() +
                            "' 2>'" + (streams / "err").string() + "' </dev/null";
  const int status = std::system(shell.c_str());
  ProgramRun run;
  run.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  run.out = contents(streams / "out");
  run.err = contents(streams / "err");
  return run;
}

void expect_refused(const ProgramRun& run, int code, const std::string& words) {
  EXPECT_EQ(run.code, code) << run.err;
  EXPECT_NE(run.err.find(words), std::string::npos) << run.err;
  EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
  EXPECT_EQ(run.out, "") << run.err;
}

const std::vector<std::string>& command_names() {
  static const std::vector<std::string> names = [] {
    const TemporaryFolder folder;
    std::vector<std::string> listed;
    std::istringstream lines(run_line("facula", folder.path()).out);
    for (std::string line; std::getline(lines, line);) {
      const std::size_t end = line.find("  ", 2);
      if (line.starts_with("  ") && end != std::string::npos)
        listed.push_back(line.substr(2, end - 2));
    }
    return listed;
  }();
  return names;
}

std::vector<std::string> examples_of(const std::string& help) {
  std::vector<std::string> examples;
  std::istringstream lines(help.substr(std::min(help.size(), help.find("\nExamples"))));
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("  facula ")) examples.push_back(line.substr(2));
  }
  return examples;
}

void make_small_capture(const std::filesystem::path& folder) {
  static const TemporaryFolder made;
  static const ProgramRun run = run_line(
      "facula simulate data/scenes/furnished_room.toml --rig data/rigs/head_fs1500.toml "
      "--position-mm -1500 -300 1100 --from-deg 0 --to-deg 8 --step-deg 2 --out capture",
      made.path());
  if (run.code != 0) throw std::runtime_error(run.err);
  std::filesystem::copy(
      made / "capture", folder / "capture", std::filesystem::copy_options::recursive);
}

bool has_file_like(const std::filesystem::path& folder, const std::string& part) {
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (entry.path().filename().string().find(part) != std::string::npos) return true;
  }
  return false;
}

}  // namespace facula
