// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/map/clearance.hpp>

#include <array>
#include <vector>

namespace facula {

struct ShortWaysOptions {
  double radius = 0.25;  ///< of the ball that goes [m], above 0
  double detour = 0.15;  ///< ways may be longer than the shortest by this share [1], 0 or more
  int num_threads = 0;   ///< 0 = all cores [1]
};

/// The cells of a box that lie on short ways between two cells. A way goes from cell to cell
/// through faces, over cells whose centres the ball certainly fits about (beside the ends: may
/// fit), and is as long as it has steps. Empty when there is none: there may be ways that leave the
/// centres.
std::vector<CellKey> cells_of_short_ways(const Clearance& clearance,
                                         const CellBox& box,
                                         const std::array<CellKey, 2>& ends,
                                         const ShortWaysOptions& options);

}  // namespace facula
