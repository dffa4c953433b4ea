// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/apps/cli/command.hpp>

namespace facula {

/// Scans -> planes, with flatness, angles and distances.
Command measure_planes_command();

}  // namespace facula
