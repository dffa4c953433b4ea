// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/polar_scan.hpp>
#include <facula/reconstruct/filter/filter_verdict.hpp>

#include <cstddef>

namespace facula {

/// Mixed points hang in the air between two surfaces, where the stripe's spot covers a depth edge.
struct MixedPointOptions {
  double max_incidence =
      1.4;                 ///< steepest angle between ray and surface normal kept [rad], below pi/2
  double min_jump = 0.01;  ///< least depth difference that counts as an edge [m]
  double jump_ratio = 0.02;  ///< or this share of the range, whichever is larger [1]
  int min_run = 3;           ///< shorter runs of rows between edges are dropped [1]
  double max_deviation = 4;  ///< of a cell beside an edge from its surface, in standard deviations
                             ///< [1]; 0 = not judged

  void check() const;
};

/// Judges the points of cloud_from_scan(scan): in every column, those beside depth edges that lie
/// in line with their ray, and short runs between edges; then those beside what edges and holes
/// there are that do not lie on the surface behind them (edge_deviants).
FilterVerdict mixed_points(const PolarScan& scan, const MixedPointOptions& options = {});

/// Clears the cells that mixed_points() names. Returns how many there were.
std::size_t remove_mixed_points(PolarScan& scan, const MixedPointOptions& options = {});

}  // namespace facula
