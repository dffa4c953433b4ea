// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/apps/cli/command.hpp>

namespace facula {

/// Capture -> polar scan.
Command extract_command();

}  // namespace facula
