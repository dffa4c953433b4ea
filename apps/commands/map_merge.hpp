// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/apps/cli/command.hpp>

namespace facula {

/// Two occupancy maps and a pose -> one map.
Command map_merge_command();

}  // namespace facula
