// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/apps/cli/command.hpp>

#include <string>
#include <vector>

namespace facula {

/// Runs the command that the words name. Returns 0 when all went well, 1 when the work failed (one
/// sentence on standard error), 2 when the command line is wrong.
int run_program(const std::vector<std::string>& words, const std::vector<Command>& commands);

}  // namespace facula
