// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace facula {

/// Logs go to standard error, never to standard output. Steps are shown only when asked for.
void set_log_verbose(bool verbose);

void log_step(const std::string& sentence);
void log_warning(const std::string& sentence);

}  // namespace facula
