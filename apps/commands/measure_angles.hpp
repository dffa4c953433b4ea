// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/apps/cli/command.hpp>

namespace facula {

/// Scans -> angles of their planes to each other and to gravity, with tolerance zones.
Command measure_angles_command();

}  // namespace facula
