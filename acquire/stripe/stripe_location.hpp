// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/stripe/stripe_detector.hpp>
#include <facula/acquire/stripe/stripe_signal.hpp>

#include <cstdint>
#include <vector>

namespace facula {

/// Where the stripe of a frame lies to a pixel or two, and the noise it has to stand out from: all
/// that is asked of the columns far from the stripe. With it, and the columns near the stripe, the
/// stripe is measured as if the whole frame were there.
struct StripeLocation {
  float noise = 0;                    ///< of the frame, see row_noise.hpp [DN]
  std::vector<std::int32_t> peak;     ///< column, -1 where nothing looks like a line [px]
  std::vector<float> peak_per_noise;  ///< response there over its noise for noise of 1 DN [1/DN]
  std::vector<float> row_noise;       ///< of the row, as the detector's filter sees it [DN]

  std::size_t size() const { return peak.size(); }
  static StripeLocation none(std::size_t rows);
};

/// First half of detect_stripe(): looks at every column of the searched region.
StripeLocation locate_stripe(const StripeSignal& signal, const StripeOptions& options);

/// Second half of detect_stripe(): looks at the columns about the located peaks only. Rows whose
/// peak the signal does not hold are not seen.
StripeProfile measure_stripe(const StripeSignal& signal,
                             const StripeLocation& location,
                             const StripeOptions& options);

}  // namespace facula
