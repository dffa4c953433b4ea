// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/apps/cli/command.hpp>

namespace facula {

/// facula map query MAP: what a map says about places, rays, boxes and balls.
Command map_query_command();

}  // namespace facula
