// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/apps/cli/command.hpp>

namespace facula {

/// Two occupancy maps -> what appeared and what vanished.
Command map_diff_command();

}  // namespace facula
