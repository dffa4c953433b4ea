// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/apps/cli/command.hpp>

namespace facula {

/// What focal length times baseline buys.
Command design_command();

}  // namespace facula
