// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/stripe/stripe_detector.hpp>

#include <vector>

namespace facula {

/// One exposure of a bracket: the same scene from the same place.
struct ExposedProfile {
  StripeProfile profile;
  double exposure = 1;  ///< time, in any unit that all share [ms], above 0
};

struct BracketOptions {
  /// Take the mean of all unclipped exposures by inverse variance instead of the best one. Only
  /// where their errors are independent (sensor noise): speckle is the same in every exposure, and
  /// its share of sigma then comes out too small.
  bool combine = false;
  double agreement = 4;  ///< exposures farther apart than so many sigmas are not of one line: only
                         ///< the best is taken [1], above 0
};

/// Merges a bracket row by row. A row that is seen unclipped in some exposures is taken from the
/// one with the least sigma (the highest signal-to-noise); a row that is clipped wherever it is
/// seen, from the shortest exposure that sees it. Sigma is that exposure's own, or with `combine`
/// that of the mean. Amplitudes are scaled to the first exposure, so that neighbouring rows
/// compare; noise is the first one's. Throws Error on no exposure, one not above 0, or profiles of
/// different size.
StripeProfile merge_bracket(const std::vector<ExposedProfile>& bracket,
                            const BracketOptions& options = {});

}  // namespace facula
