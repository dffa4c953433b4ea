// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/apps/cli/command.hpp>

#include <vector>

namespace facula {

/// All commands, in the order of help: one row per command.
std::vector<Command> all_commands();

}  // namespace facula
