// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/polar_scan.hpp>

#include <cstddef>

namespace facula {

/// Mixed points hang in the air between two surfaces, where the stripe's spot covers a depth edge.
struct MixedPointOptions {
  double max_incidence =
      1.4;                 ///< steepest angle between ray and surface normal kept [rad], below pi/2
  double min_jump = 0.01;  ///< least depth difference that counts as an edge [m]
  double jump_ratio = 0.02;  ///< or this share of the range, whichever is larger [1]
  int min_run = 3;           ///< shorter runs of rows between edges are dropped [1]

  void check() const;
};

/// Clears, in every column, the cells beside depth edges that lie in line with their ray, and short
/// runs between edges. Returns how many cells were cleared.
std::size_t remove_mixed_points(PolarScan& scan, const MixedPointOptions& options = {});

}  // namespace facula
