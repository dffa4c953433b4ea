// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/map/scan_cells.hpp>

namespace facula {

/// How sure a point is of its cell, in eighths: the share of a normal distribution of `sigma` [m]
/// within half a cell's edge to either side, rounded, at least 1. 8 where sigma is not known (0 or
/// not finite).
std::uint8_t sure_eighths(float sigma, double resolution);

/// Gives every cell that rays ended in the eighths of the surest point in it. `cells` are those of
/// the cloud, with all hits sure; afterwards the hits of a brick may stand in several entries. A
/// cloud without sigmas changes nothing.
void weigh_hits(const PointCloud& cloud, const CastOptions& options, ScanCells& cells);

}  // namespace facula
