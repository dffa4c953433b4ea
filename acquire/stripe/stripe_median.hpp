// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/stripe/stripe_detector.hpp>

namespace facula {

/// The 3 x 1 median along the stripe (source D): a position between two seen neighbours becomes the
/// median of the three, against speckle and single wrong rows. Its sigma becomes that of the median
/// of three normals whose means lie one slope apart: 0.6698 sigma on a level stripe (0.4487 of the
/// variance, e.g. David and Nagaraja, Order Statistics, 2003), the row's own where the stripe leans
/// by much more than sigma per row; neighbours' errors go together afterwards. Where they did
/// before
/// (`rows_share_light`), sigma is left as it was. Everything else of a row stays its own.
void median_along(StripeProfile& profile, bool rows_share_light);

}  // namespace facula
