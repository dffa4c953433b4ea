// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/apps/cli/command.hpp>

namespace facula {

/// Scans -> flatness of every plane after ISO 12781.
Command measure_flatness_command();

}  // namespace facula
