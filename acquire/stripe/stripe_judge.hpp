// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/stripe/stripe_candidate.hpp>
#include <facula/acquire/stripe/stripe_detector.hpp>

#include <algorithm>
#include <cstddef>
#include <memory>
#include <vector>

namespace facula {

/// What a detector found in the rows of a frame, before it is judged; see StripeCandidate for the
/// quantities. One array each, so that many rows are judged at once.
class MeasuredRows {
 public:
  /// `noise` is that of the frame [DN].
  MeasuredRows(std::size_t rows, float noise);

  void set(std::size_t r, const StripeCandidate& found);
  void set_sigma_step(std::size_t r, float step);

  /// seen is 1 where something was found; position, amplitude, width and saturated are filled.
  StripeProfile profile;
  std::vector<float> sigma_step;  ///< empty where all are 0 [px]
  float residual_freedom = 1;     ///< the same for all rows [1]

  /// Sets everything but the profile to 0.
  void clear() { std::fill_n(block_.get(), 6 * profile.size(), 0.0F); }

  float* row_noise() { return array(0); }
  float* snr_per_noise() { return array(1); }
  float* sigma_per_noise() { return array(2); }
  float* residual() { return array(3); }
  float* residual_share() { return array(4); }
  float* position_share() { return array(5); }

 private:
  float* array(std::size_t i) { return block_.get() + i * profile.size(); }

  std::unique_ptr<float[]> block_;  ///< not initialised
};

class ExactMisfit;

/// Drops what does not stand out from the noise or does not hang together from row to row, and
/// works out the sigma of the rest. `exact` is asked where the quick misfits say that something is
/// amiss: photon noise, a line of another width than expected, no single line.
StripeProfile judge_rows(MeasuredRows rows, const StripeOptions& options, const ExactMisfit& exact);

}  // namespace facula
