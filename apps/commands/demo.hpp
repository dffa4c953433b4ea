// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/apps/cli/command.hpp>

namespace facula {

/// The whole road on a simulated room and object, checked against the truth.
Command demo_command();

}  // namespace facula
