// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/apps/cli/command.hpp>

namespace facula {

/// facula map plan MAP --from-m X Y Z --to-m X Y Z: a path that keeps clear of obstacles.
Command map_plan_command();

}  // namespace facula
