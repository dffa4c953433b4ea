// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/median.hpp>
#include <facula/acquire/stripe/stripe_sigma.hpp>

#include <algorithm>
#include <cmath>

namespace facula {
namespace {

constexpr float kBeyondChance = 3.09F;  // one in a thousand, in standard deviations

}  // namespace

float mean_square_at(float freedom, float z) {
  const float ninth = 2 / (9 * freedom);
  const float root = 1 - ninth + z * std::sqrt(ninth);
  return root * root * root;
}

float noise_about(const StripeCandidate& found, float frame_noise) {
  return found.row_noise > 1.5F * frame_noise ? found.row_noise : frame_noise;
}

float signal_noise_gain(const std::vector<std::optional<StripeCandidate>>& candidates,
                        float frame_noise) {
  std::vector<float> gains;
  for (const auto& found : candidates) {
    if (!found || found->saturated || !(found->amplitude > 0)) continue;
    if (!(found->residual_freedom > 0) || !(found->residual_share > 0)) continue;
    const float square = found->residual / mean_square_at(found->residual_freedom, 0);
    gains.push_back((square - frame_noise * frame_noise) /
                    (found->amplitude * found->residual_share));
  }
  if (gains.size() < 16) return 0;
  return std::max(0.0F, median(gains));
}

float position_sigma(const StripeCandidate& found, float frame_noise, float gain) {
  const float noise = noise_about(found, frame_noise);
  const float photons = gain * found.amplitude;
  const float expected = noise * noise + photons * found.residual_share;
  float variance = noise * noise + photons * found.position_share;
  // A profile that is no single Gaussian (a depth edge cuts it, two surfaces share it) says so by
  // its misfit; the position is then uncertain in the same measure.
  if (!found.saturated && found.residual_freedom > 0 &&
      found.residual > mean_square_at(found.residual_freedom, kBeyondChance) * expected) {
    variance = std::max(variance, found.residual);
  }
  return std::hypot(found.sigma_per_noise * std::sqrt(variance), found.sigma_step);
}

}  // namespace facula
