// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/nearest_name.hpp>
#include <facula/acquire/core/version.hpp>
#include <facula/apps/cli/complain.hpp>
#include <facula/apps/cli/deliver.hpp>
#include <facula/apps/cli/help.hpp>
#include <facula/apps/cli/log.hpp>
#include <facula/apps/cli/output_path.hpp>
#include <facula/apps/cli/program.hpp>
#include <facula/apps/cli/usage_error.hpp>

#include <algorithm>
#include <cstddef>
#include <exception>
#include <filesystem>

namespace facula {
namespace {

constexpr int kMostThreads = 1024;

/// What every command understands besides its own arguments.
struct CommonArguments {
  std::filesystem::path json;
  int threads = 0;
  bool verbose = false;
  bool help = false;
};

void declare_common(Arguments& arguments, CommonArguments& common) {
  arguments.output("--json",
                   common.json,
                   "write all figures to this file; - is standard output, then nothing else is "
                   "written there");
  arguments.whole("--threads", common.threads, "threads that work at once, 0 = all cores");
  arguments.flag("--verbose", common.verbose, "log every step on standard error");
  arguments.flag("--help", common.help, "show this and stop");
}

bool asks_for_help(const std::vector<std::string>& words) {
  return std::any_of(words.begin(), words.end(), [](const std::string& word) {
    return word == "--help" || word == "-h";
  });
}

void run_command(const Command& command, const std::vector<std::string>& words) {
  Arguments arguments;
  CommonArguments common;
  command.declare(arguments);
  declare_common(arguments, common);
  if (asks_for_help(words)) {
    print(command_help(command, arguments));
    return;
  }
  parse_arguments(arguments, words);
  if (common.threads > kMostThreads) {
    fail_usage(
        "--threads: expected 0 to ", kMostThreads, ", got ", common.threads, "; 0 takes all cores");
  }
  if (!common.json.empty() && common.json != "-") check_output(common.json);
  set_log_verbose(common.verbose);
  Session session;
  session.num_threads = common.threads;
  command.run(session);
  session.end_steps();
  deliver(session.figures, common.json);
}

int guarded_run(const Command& command, const std::vector<std::string>& words) {
  try {
    run_command(command, words);
    return kOk;
  } catch (...) {
    return complain("facula " + command.name, std::current_exception());
  }
}

/// The command whose name the first words spell, and how many words that took.
const Command* find_command(const std::vector<std::string>& words,
                            const std::vector<Command>& commands,
                            std::size_t& taken) {
  for (taken = std::min<std::size_t>(2, words.size()); taken > 0; --taken) {
    std::string name = words[0];
    if (taken == 2) name += " " + words[1];
    for (const Command& command : commands) {
      if (command.name == name) return &command;
    }
  }
  return nullptr;
}

bool begins_commands(const std::string& word, const std::vector<Command>& commands) {
  return std::any_of(commands.begin(), commands.end(), [&](const Command& command) {
    return command.name.starts_with(word + " ");
  });
}

/// 'facula calibrate camra': what there is to calibrate instead.
int unknown_second_word(const std::vector<std::string>& words,
                        const std::vector<Command>& commands) {
  std::vector<std::string> seconds;
  for (const Command& command : commands) {
    if (command.name.starts_with(words[0] + " "))
      seconds.push_back(command.name.substr(words[0].size() + 1));
  }
  const std::string near = nearest_name(words[1], seconds);
  return complain("facula " + words[0],
                  "expected what to " + words[0] + ", got '" + words[1] + "'; " +
                      (near.empty() ? "'facula " + words[0] + "' alone lists it"
                                    : "did you mean 'facula " + words[0] + " " + near + "'?"),
                  kWrongUsage);
}

int unknown_command(const std::vector<std::string>& words, const std::vector<Command>& commands) {
  std::vector<std::string> names;
  names.reserve(commands.size());
  for (const Command& command : commands) names.push_back(command.name);
  const std::string typed =
      words.size() > 1 && !words[1].starts_with("-") ? words[0] + " " + words[1] : words[0];
  std::string near = nearest_name(words[0], names);
  if (near.empty()) near = nearest_name(typed, names);
  return complain("facula",
                  "expected a command, got '" + words[0] + "'; " +
                      (near.empty() ? "'facula' alone lists them" : "did you mean '" + near + "'?"),
                  kWrongUsage);
}

}  // namespace

int run_program(const std::vector<std::string>& words, const std::vector<Command>& commands) {
  try {
    if (words.empty() || words[0] == "--help" || words[0] == "-h" ||
        (words.size() == 1 && words[0] == "help")) {
      print(program_help(commands));
      return kOk;
    }
    if (words[0] == "--version") {
      print(std::string("facula ") + version() + "\n");
      return kOk;
    }
    if (words[0] == "help") {
      // 'facula help calibrate camera' is 'facula calibrate camera --help'.
      std::vector<std::string> asked(words.begin() + 1, words.end());
      asked.emplace_back("--help");
      return run_program(asked, commands);
    }
    std::size_t taken = 0;
    const Command* command = find_command(words, commands, taken);
    if (command != nullptr) {
      return guarded_run(*command,
                         {words.begin() + static_cast<std::ptrdiff_t>(taken), words.end()});
    }
    if (!begins_commands(words[0], commands)) return unknown_command(words, commands);
    if (words.size() > 1 && !asks_for_help({words[1]})) return unknown_second_word(words, commands);
    print(first_word_help(words[0], commands));
    return kOk;
  } catch (...) {
    return complain("facula", std::current_exception());
  }
}

}  // namespace facula
