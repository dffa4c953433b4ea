// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/polar_scan.hpp>

#include <vector>

namespace facula {

struct EdgeDeviationOptions {
  double max_incidence = 1.4;  ///< steeper steps between cells are depth edges [rad], below pi/2
  double max_deviation = 4.0;  ///< from the surface, in standard deviations [1], above 0
  double min_loss = 1.3;       ///< sigma of a mixed cell over its surface's, at equal range [1]
  int edge_rows = 3;           ///< rows beside an edge that are judged [1], at least 1

  void check() const;
};

/// Cells beside a depth edge or a hole that do not lie on their own surface. Where the stripe runs
/// along an edge, part of its light falls past it: what is left has another middle, and the whole
/// stripe seems nearer or farther by up to its half width times the range's change per pixel. The
/// surface is continued to the cell from the cells on the side away from the edge, as a plane; a
/// cell is named when the mean deviation of the cells around it along the edge exceeds
/// max_deviation of its standard deviations, taken from sigma and from how well the plane fits, and
/// its sigma shows that light was lost. Cells whose sigma is not known (is_known_sigma) neither are
/// judged nor judge others. One entry per cell, 1 where it deviates.
std::vector<char> edge_deviants(const PolarScan& scan, const EdgeDeviationOptions& options = {});

}  // namespace facula
