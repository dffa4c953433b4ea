// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/apps/cli/session.hpp>
#include <facula/apps/commands/posed_scans.hpp>

#include <string>

namespace facula {

/// Several scans that all stand at the same pose have none: registers them with each other
/// (`how` "auto"), whatever their poses say ("always"), or leaves them as they are ("never"). Scans
/// that cannot be placed are taken out of the project, with a note that gives the reason. Throws
/// Error when fewer than two could be placed.
void place_scans(PosedScans& scans, const std::string& how, Session& session);

}  // namespace facula
