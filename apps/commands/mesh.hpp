// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/apps/cli/command.hpp>

namespace facula {

/// Scans -> triangle mesh.
Command mesh_command();

}  // namespace facula
