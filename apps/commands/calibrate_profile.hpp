// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/apps/cli/command.hpp>

namespace facula {

/// Test pieces or known points -> profile calibration.
Command calibrate_profile_command();

}  // namespace facula
