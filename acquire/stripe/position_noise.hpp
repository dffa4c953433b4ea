// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/stripe/stripe_candidate.hpp>

#include <algorithm>
#include <cmath>

namespace facula {

/// Carries the noise of pixels into a position that depends on them by known derivatives w_i
/// [px/DN]: variance = sum w_i^2 v_i, with v_i = n^2 + g S_i for noise n and a part that follows
/// the signal S_i (photons, speckle).
class PositionNoise {
 public:
  /// A pixel of height `height` [DN] over the surroundings moves the position by `weight` [px/DN].
  void add(double weight, double height) {
    const double square = weight * weight;
    sum_ += weight;
    squares_ += square;
    shared_ += square * std::max(0.0, height);
  }

  /// The heights share one background, the mean of `count` other pixels.
  void share_background(int count) {
    if (count > 0) squares_ += sum_ * sum_ / count;
  }

  /// Writes sigma_per_noise and position_share; the amplitude must be there already.
  void store(StripeCandidate& found) const {
    found.sigma_per_noise = static_cast<float>(std::sqrt(squares_));
    const double full = squares_ * static_cast<double>(found.amplitude);
    found.position_share = full > 0 ? static_cast<float>(shared_ / full) : 0;
  }

 private:
  double sum_ = 0;
  double squares_ = 0;
  double shared_ = 0;
};

}  // namespace facula
