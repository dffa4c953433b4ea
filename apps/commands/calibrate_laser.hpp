// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/apps/cli/command.hpp>

namespace facula {

/// Pictures of a board with the laser line on it -> a sheet of light of a rig.
Command calibrate_laser_command();

}  // namespace facula
