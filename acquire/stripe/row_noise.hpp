// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/stripe/stripe_signal.hpp>

namespace facula {

/// Noise of a frame [DN, 1 standard deviation]: the median over about 100 rows of a robust estimate
/// from second differences, the surroundings of the row's brightest pixel left out. At least the
/// quantisation noise 1/sqrt(12) of an 8-bit frame.
float estimate_noise(const StripeSignal& signal);

}  // namespace facula
