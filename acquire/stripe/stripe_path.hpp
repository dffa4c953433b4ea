// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

namespace facula {

/// One of the places in a row where the stripe might be.
struct PathPlace {
  double position = 0;  ///< [px]
  double gain = 0;      ///< how much it looks like the stripe: a path earns it by passing [1]
};

/// What a path pays for not going straight on, in the unit of PathPlace::gain.
struct PathPrices {
  double step = 3;         ///< sideways step per row that costs 1; its square counts [px], above 0
  double jump = 4;         ///< dearest step: a depth edge, or a new piece of stripe [1], above 0
  double gap_row = 0.05;   ///< per row passed over without a place [1], 0 or more
  std::size_t reach = 24;  ///< rows a piece may be interrupted before it costs a jump [1], above 0
};

/// The most worthwhile way through rows of places, at most one per row: maximises the gains of the
/// places passed less the prices of the steps between them, by dynamic programming over the rows
/// (Bellman 1957). A step of d px over n rows costs (d / step)^2 / n, what a random walk would, but
/// never more than a jump; so does a step over more than `reach` rows. Returns the number of the
/// place per row, -1 where the path passes none. Every path that consists of one place is worth its
/// gain; of equal paths the one of the earlier places is taken.
std::vector<int> best_path(const std::vector<std::vector<PathPlace>>& rows,
                           const PathPrices& prices = {});

}  // namespace facula
