// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace facula {

/// What a run of the program left behind.
struct ProgramRun {
  int code = -1;  ///< exit code; 128 and above: ended by a signal
  std::string out;
  std::string err;
};

/// Runs a shell line in a folder; `facula` in it is the program just built.
ProgramRun run_line(const std::string& line, const std::filesystem::path& folder);

/// Expects a run to have failed with this code, nothing on standard output and one sentence on
/// standard error that holds the words.
void expect_refused(const ProgramRun& run, int code, const std::string& words);

/// The commands the program has, as users type them.
const std::vector<std::string>& command_names();

/// The example lines at the end of the help of a command.
std::vector<std::string> examples_of(const std::string& help);

/// A capture of a few frames for tests to spoil, in `folder`/capture; simulated once per program.
void make_small_capture(const std::filesystem::path& folder);

/// Whether any file below the folder holds that name's text in its name.
bool has_file_like(const std::filesystem::path& folder, const std::string& part);

}  // namespace facula
