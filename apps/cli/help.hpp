// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/apps/cli/command.hpp>

#include <string>
#include <vector>

namespace facula {

/// What `facula` alone says: what it is for and its commands.
std::string program_help(const std::vector<Command>& commands);

/// What `facula calibrate` says: the commands that begin with that word.
std::string first_word_help(const std::string& word, const std::vector<Command>& commands);

/// What `facula COMMAND --help` says: description, arguments with units and defaults, examples.
std::string command_help(const Command& command, const Arguments& arguments);

/// The same of a program of its own; `called` is what people type for it.
std::string program_help(const Command& program,
                         const Arguments& arguments,
                         const std::string& called);

}  // namespace facula
