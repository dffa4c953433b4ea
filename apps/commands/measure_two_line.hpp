// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/apps/cli/command.hpp>

namespace facula {

/// A frame of a two-line head -> distance per segment.
Command measure_two_line_command();

}  // namespace facula
