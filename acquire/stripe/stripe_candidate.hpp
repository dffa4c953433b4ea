// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/stripe/channel.hpp>
#include <facula/acquire/stripe/stripe_detector.hpp>

#include <optional>

namespace facula {

/// One stripe in one row, before it is judged against the noise of the whole frame.
struct StripeCandidate {
  float position = 0;         ///< [px]
  float amplitude = 0;        ///< height over the surroundings [DN]
  float background = 0;       ///< level of the surroundings [DN]
  float width = 0;            ///< standard deviation of the profile [px]
  float row_noise = 0;        ///< of this row, as the detector's filter sees it [DN]
  float snr_per_noise = 0;    ///< response over its standard deviation for noise of 1 DN [1/DN]
  float sigma_per_noise = 0;  ///< standard deviation of position for noise of 1 DN [px/DN]
  float residual = 0;         ///< mean square left by the fitted profile [DN^2]
  float residual_share = 0;  ///< of a variance that follows the signal: its mean where the residual
                             ///< is taken over its value at the amplitude [1]
  float position_share = 0;  ///< the same where the position is taken from [1]
  bool saturated = false;    ///< the core is clipped
};

/// What a detector is: a way to find the strongest stripe in one row of a signal.
class RowDetector {
 public:
  RowDetector() = default;
  virtual ~RowDetector() = default;
  RowDetector(const RowDetector&) = delete;
  RowDetector& operator=(const RowDetector&) = delete;

  /// The strongest stripe of row r between columns [begin, end), if the row has one at all.
  virtual std::optional<StripeCandidate> find(const StripeSignal& signal,
                                              int r,
                                              int begin,
                                              int end) const = 0;
};

}  // namespace facula
