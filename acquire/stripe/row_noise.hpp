// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/stripe/stripe_signal.hpp>

#include <vector>

namespace facula {

/// Noise of a frame [DN, 1 standard deviation]: the median over some rows (10 000 pixels or more
/// where the frame has them) of a robust estimate from second differences, the surroundings of the
/// row's brightest pixel left out. At least the quantisation noise 1/sqrt(12) of an 8-bit frame.
float estimate_noise(const StripeSignal& signal);

/// Every how many rows one is looked at, the first after half as many [1].
int noise_row_step(int rows, int cols);

/// Noise of a row whose lower three quarters of sizes of second differences, `count` of them, have
/// this sum [DN].
float row_noise_from(int sum, int count);

/// Noise of a frame from that of its rows, which are put into another order [DN].
float frame_noise_from(std::vector<float>& per_row);

}  // namespace facula
