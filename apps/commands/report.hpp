// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/apps/cli/command.hpp>

namespace facula {

/// Results of other commands -> one HTML page.
Command report_command();

}  // namespace facula
