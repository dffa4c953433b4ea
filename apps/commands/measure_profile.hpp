// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/apps/cli/command.hpp>

namespace facula {

/// Scans -> steps, sides, rods and balls.
Command measure_profile_command();

}  // namespace facula
