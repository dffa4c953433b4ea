// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/apps/cli/session.hpp>
#include <facula/apps/commands/plane_search.hpp>

namespace facula {

/// Finds the zero of the tilt axis in every list of range, pan and tilt, for rising and falling
/// sweeps apart, and reports them with the median over the lists' rising sweeps. Throws Error when
/// an input is no such list.
void report_tilt_zeros(const PlaneSearch& search, Session& session);

}  // namespace facula
