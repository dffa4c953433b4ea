// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/stripe/stripe_candidate.hpp>

#include <optional>
#include <vector>

namespace facula {

/// Where a mean of `freedom` independent squares of variance 1 lies `z` standard normal deviations
/// up its distribution (Wilson and Hilferty 1931); z = 0 is the median.
float mean_square_at(float freedom, float z);

/// The frame's noise, or the row's own where that is clearly larger: one row is a small sample
/// [DN].
float noise_about(const StripeCandidate& found, float frame_noise);

/// How the variance grows with the signal (photon noise, speckle): the median over the stripes of
/// (misfit - noise^2) over the mean signal under it, at least 0 [DN]. Clipped stripes and those
/// without a misfit say nothing about it; fewer than 16 give 0.
float signal_noise_gain(const std::vector<std::optional<StripeCandidate>>& candidates,
                        float frame_noise);

/// Standard deviation of a candidate's position [px]: pixel noise and signal noise carried through
/// the detector's formula, or its misfit in place of both where that is beyond chance (one in a
/// thousand), and the part that no light removes.
float position_sigma(const StripeCandidate& found, float frame_noise, float gain);

}  // namespace facula
