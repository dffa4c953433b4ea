// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/apps/cli/command.hpp>

namespace facula {

/// Scans -> distances of their parallel planes, with uncertainty and parallelism.
Command measure_distance_command();

}  // namespace facula
