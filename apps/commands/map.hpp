// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/apps/cli/command.hpp>

namespace facula {

/// Scans -> occupancy map and navigation grid.
Command map_command();

}  // namespace facula
