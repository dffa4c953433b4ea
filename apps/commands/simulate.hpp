// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/apps/cli/command.hpp>

namespace facula {

/// Scene and rig -> capture, as the head's camera would have recorded it.
Command simulate_command();

}  // namespace facula
