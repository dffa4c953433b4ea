// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/apps/cli/command.hpp>

namespace facula {

/// Line separations at known distances -> two-line head.
Command calibrate_two_line_command();

}  // namespace facula
