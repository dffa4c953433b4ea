// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/apps/cli/command.hpp>

namespace facula {

/// Walls at several distances -> pixel compensation table.
Command calibrate_compensation_command();

}  // namespace facula
