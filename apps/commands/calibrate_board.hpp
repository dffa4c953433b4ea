// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/apps/cli/command.hpp>

namespace facula {

/// A rig -> pictures of a board as its camera would take them.
Command calibrate_board_command();

}  // namespace facula
