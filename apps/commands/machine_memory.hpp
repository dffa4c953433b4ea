// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace facula {

/// What this process may hold in memory [byte]: the machine's, or less where its control group or
/// its own limit (ulimit -v) says so. The same from run to run, whatever else is running.
double machine_memory();

}  // namespace facula
