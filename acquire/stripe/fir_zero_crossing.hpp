// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/stripe/row_detector.hpp>

#include <memory>

namespace facula {

/// The default detector: the stripe's middle is where the row, smoothed by a Gaussian of the line's
/// own width and differentiated, crosses zero downwards (Forest et al. 2004; Steger 1998 in one
/// dimension). For a line of that width the estimate reaches the Cramér-Rao bound; a flat pedestal
/// and a clipped core do not shift it, a ramp of ambient light does (by its slope over the bend of
/// the line, 0.01 px per 0.1 DN/px under a line of 120 DN): subtract a background there. `sigma` is
/// the filter's width [px].
std::unique_ptr<RowDetector> make_fir_zero_crossing(double sigma);

}  // namespace facula
