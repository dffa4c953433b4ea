// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/map/obstacle_bits.hpp>

#include <cstdint>
#include <limits>
#include <vector>

namespace facula {

/// Stands for every squared distance above the limit, and for "there is none".
inline constexpr std::int32_t kBeyond = std::numeric_limits<std::int32_t>::max();

/// Longest diagonal of a box whose squared distances fit into 32 bits [cells].
inline constexpr int kLongestDiagonal = 46340;

/// Squared distance [cells^2] from the centre of every cell to the centre of the nearest cell of
/// the other kind within the box: of the nearest obstacle, above 0, for cells that are none; of the
/// nearest cell that is none, below 0, for obstacles. Above `limit_squared`: kBeyond with the sign.
/// Cells in the order x + nx (y + ny z). Exact, in whole numbers: a scan along x, then lower
/// envelopes of parabolas along y and z (Meijster, Roerdink and Hesselink 2000; Felzenszwalb and
/// Huttenlocher 2012). The same for any number of threads. The box's diagonal may be
/// kLongestDiagonal cells long.
std::vector<std::int32_t> signed_squared_distances(const ObstacleBits& obstacles,
                                                   std::int32_t limit_squared,
                                                   int num_threads);

}  // namespace facula
