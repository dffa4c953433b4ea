// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/stripe/stripe_candidate.hpp>
#include <facula/acquire/stripe/stripe_detector.hpp>
#include <facula/acquire/stripe/stripe_sigma.hpp>

namespace facula {

/// Whether a candidate is strong, high and narrow enough for a stripe.
inline bool stands_out(const StripeCandidate& found, float noise, const StripeOptions& options) {
  const double row_noise = static_cast<double>(noise_about(found, noise));
  return static_cast<double>(found.snr_per_noise) >= options.min_snr * row_noise &&
         static_cast<double>(found.amplitude) >= options.min_amplitude &&
         static_cast<double>(found.width) <= options.max_width_ratio * options.sigma;
}

}  // namespace facula
