// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/apps/cli/command.hpp>

namespace facula {

/// Positions at known distances -> range model.
Command calibrate_range_command();

}  // namespace facula
