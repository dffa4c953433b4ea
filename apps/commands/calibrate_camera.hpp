// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/apps/cli/command.hpp>

namespace facula {

/// Pictures of a board -> the camera of a rig.
Command calibrate_camera_command();

}  // namespace facula
