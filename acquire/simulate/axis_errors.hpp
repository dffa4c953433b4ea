// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/simulate/conditions.hpp>

#include <cstdint>
#include <vector>

namespace facula {

/// Where the axis really is when the frame of each position of the programme is taken: the play of
/// the drive, then its periodic error, then the way it goes on during the latency, then noise.
/// Before its first reversal the axis shows no play. The same seed gives the same positions.
std::vector<double> travelled_positions(const std::vector<double>& programme,
                                        const AxisErrors& errors,
                                        std::uint64_t seed);

}  // namespace facula
