// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/apps/cli/command.hpp>

namespace facula {

/// What a file is, in figures.
Command info_command();

}  // namespace facula
