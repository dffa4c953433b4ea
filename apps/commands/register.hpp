// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/apps/cli/command.hpp>

namespace facula {

/// Scans with rough poses -> poses.toml with poses that fit.
Command register_command();

}  // namespace facula
