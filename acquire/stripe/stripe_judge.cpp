// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/median.hpp>
#include <facula/acquire/stripe/exact_misfit.hpp>
#include <facula/acquire/stripe/stripe_judge.hpp>
#include <facula/acquire/stripe/stripe_sigma.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace facula {
namespace {

/// The frame's noise, or the row's own where that is clearly larger: one row is a small sample.
float noise_about(float row_noise, float frame_noise) {
  return row_noise > 1.5F * frame_noise ? row_noise : frame_noise;
}

void keep_what_stands_out(MeasuredRows& rows, const StripeOptions& options) {
  StripeProfile& profile = rows.profile;
  const auto min_snr = static_cast<float>(options.min_snr);
  const auto min_amplitude = static_cast<float>(options.min_amplitude);
  const auto max_width = static_cast<float>(options.max_width_ratio * options.sigma);
  const float* row_noise = rows.row_noise();
  const float* snr = rows.snr_per_noise();
  const float* amplitude = profile.amplitude.data();
  const float* width = profile.width.data();
  std::uint8_t* seen = profile.seen.data();
  const float frame_noise = profile.noise;
  const std::size_t count = profile.size();
  for (std::size_t r = 0; r < count; ++r) {
    const bool strong = snr[r] >= min_snr * noise_about(row_noise[r], frame_noise);
    const bool stands_out = strong & (amplitude[r] >= min_amplitude) & (width[r] <= max_width);
    seen[r] = stands_out ? seen[r] : std::uint8_t{0};
  }
}

/// Clears rows that do not hang together with their neighbours over options.min_run rows: a line
/// goes on from row to row, grain and sparks do not. A run may skip up to two rows.
void drop_short_runs(StripeProfile& profile, const StripeOptions& options) {
  const auto max_step = static_cast<float>(4 * options.sigma + 2);
  std::size_t first = 0;
  std::size_t last = 0;
  int length = 0;
  const auto end_run = [&] {
    for (std::size_t r = first; length < options.min_run && length > 0 && r <= last; ++r) {
      profile.seen[r] = 0;
    }
    length = 0;
  };
  for (std::size_t r = 0; r < profile.size(); ++r) {
    if (profile.seen[r] == 0) continue;
    const float step = std::abs(profile.position[r] - profile.position[last]);
    const bool goes_on =
        length > 0 && r - last <= 3 && step <= max_step * static_cast<float>(r - last);
    if (!goes_on) {
      end_run();
      first = r;
    }
    last = r;
    ++length;
  }
  end_run();
}

constexpr float kBeyondChance = 3.09F;  // one in a thousand, in standard deviations
constexpr std::size_t kFewest = 16;     // stripes that a gain is taken from
// Of the median of 128 quick misfits over the noise squared: 2.4 of its standard deviations.
constexpr float kMostExcess = 1.12F;

float exact_gain(const MeasuredRows& rows, const ExactMisfit& exact) {
  const StripeProfile& profile = rows.profile;
  std::vector<float> gains;
  const std::size_t step = std::max<std::size_t>(1, profile.size() / 64);
  for (std::size_t r = step / 2; r < profile.size(); r += step) {
    if (profile.seen[r] == 0 || profile.saturated[r] != 0) continue;
    const StripeCandidate misfit = exact.of(rows, r);
    const float under = profile.amplitude[r] * misfit.residual_share;
    if (!(misfit.residual_freedom > 0) || !(under > 0)) continue;
    const float square = misfit.residual / mean_square_at(misfit.residual_freedom, 0);
    gains.push_back((square - profile.noise * profile.noise) / under);
  }
  return gains.size() < kFewest ? 0 : std::max(0.0F, median(gains));
}

/// How the variance grows with the signal (photon noise, speckle): the median over stripes of
/// (misfit - noise^2) over the mean signal under it, at least 0 [DN]. Clipped stripes say nothing
/// about it. Some 128 to 255 rows are enough for quick misfits; where these exceed the noise by
/// more than chance, 64 to 127 rows are fitted exactly.
float signal_noise_gain(MeasuredRows& rows, const ExactMisfit& exact) {
  const float per_median = 1 / mean_square_at(rows.residual_freedom, 0);
  const StripeProfile& profile = rows.profile;
  const float noise2 = profile.noise * profile.noise;
  std::vector<float> gains;
  gains.reserve(256);
  std::size_t large = 0;
  const std::size_t step = std::max<std::size_t>(1, profile.size() / 128);
  for (std::size_t r = step / 2; r < profile.size(); r += step) {
    const float under = profile.amplitude[r] * rows.residual_share()[r];
    if (profile.seen[r] == 0 || profile.saturated[r] != 0 || !(under > 0)) continue;
    const float square = rows.residual()[r] * per_median;
    large += square > kMostExcess * noise2 ? 1 : 0;
    gains.push_back((square - noise2) / under);
  }
  if (gains.size() < kFewest) return 0;
  const bool median_is_large = gains.size() - large <= gains.size() / 2;
  if (median_is_large) return exact_gain(rows, exact);
  return std::max(0.0F, median(gains));
}

/// What an exact fit leaves of a row where that is more than noise and light explain, else 0 [DN].
float misfit_beyond_chance(MeasuredRows& rows,
                           std::size_t r,
                           float gain,
                           const ExactMisfit& exact) {
  const StripeCandidate misfit = exact.of(rows, r);
  if (!(misfit.residual_freedom > 0)) return 0;
  const float noise = noise_about(rows.row_noise()[r], rows.profile.noise);
  const float photons = gain * rows.profile.amplitude[r];
  const float expected = noise * noise + photons * misfit.residual_share;
  const float most = mean_square_at(misfit.residual_freedom, kBeyondChance) * expected;
  return misfit.residual > most ? std::sqrt(misfit.residual) : 0;
}

/// A profile that is no single Gaussian (a depth edge cuts it, two surfaces share it) says so by
/// its misfit; the position is then uncertain in the same measure.
void work_out_sigma(MeasuredRows& rows, float gain, const ExactMisfit& exact) {
  StripeProfile& profile = rows.profile;
  const float* row_noise = rows.row_noise();
  const float* per_noise = rows.sigma_per_noise();
  const float* residual = rows.residual();
  const float* residual_share = rows.residual_share();
  const float* position_share = rows.position_share();
  const float* amplitude = profile.amplitude.data();
  float* sigma = profile.sigma.data();
  const float frame_noise = profile.noise;
  const float beyond_chance = mean_square_at(rows.residual_freedom, kBeyondChance);
  const std::size_t count = profile.size();
  // Floats alone in the first loop: many rows at once.
  const std::unique_ptr<float[]> excess(new float[count]);
  for (std::size_t r = 0; r < count; ++r) {
    const float noise = noise_about(row_noise[r], frame_noise);
    const float photons = gain * amplitude[r];
    const float expected = noise * noise + photons * residual_share[r];
    const float variance = noise * noise + photons * position_share[r];
    excess[r] = residual[r] - beyond_chance * expected;
    sigma[r] = per_noise[r] * std::sqrt(variance);
  }
  for (std::size_t r = 0; r < count; ++r) {
    if (!(excess[r] > 0) || profile.seen[r] == 0 || profile.saturated[r] != 0) continue;
    sigma[r] = std::max(sigma[r], per_noise[r] * misfit_beyond_chance(rows, r, gain, exact));
  }
  for (std::size_t r = 0; r < rows.sigma_step.size(); ++r) {
    sigma[r] = std::hypot(sigma[r], rows.sigma_step[r]);
  }
}

void clear_unseen(StripeProfile& profile) {
  for (std::size_t r = 0; r < profile.size(); ++r) {
    if (profile.seen[r] != 0) continue;
    profile.position[r] = 0;
    profile.sigma[r] = 0;
    profile.amplitude[r] = 0;
    profile.width[r] = 0;
    profile.saturated[r] = 0;
  }
}

}  // namespace

MeasuredRows::MeasuredRows(std::size_t rows, float noise)
    : profile(StripeProfile::none(rows)), block_(new float[6 * rows]) {
  profile.noise = noise;
}

void MeasuredRows::set(std::size_t r, const StripeCandidate& found) {
  profile.seen[r] = 1;
  profile.position[r] = found.position;
  profile.amplitude[r] = found.amplitude;
  profile.width[r] = found.width;
  profile.saturated[r] = found.saturated ? 1 : 0;
  row_noise()[r] = found.row_noise;
  snr_per_noise()[r] = found.snr_per_noise;
  sigma_per_noise()[r] = found.sigma_per_noise;
  residual()[r] = found.residual;
  residual_share()[r] = found.residual_share;
  position_share()[r] = found.position_share;
  set_sigma_step(r, found.sigma_step);
  if (found.residual_freedom > 0) residual_freedom = found.residual_freedom;
}

void MeasuredRows::set_sigma_step(std::size_t r, float step) {
  if (step != 0 && sigma_step.empty()) sigma_step.assign(profile.size(), 0);
  if (!sigma_step.empty()) sigma_step[r] = step;
}

StripeProfile judge_rows(MeasuredRows rows,
                         const StripeOptions& options,
                         const ExactMisfit& exact) {
  keep_what_stands_out(rows, options);
  drop_short_runs(rows.profile, options);
  work_out_sigma(rows, signal_noise_gain(rows, exact), exact);
  clear_unseen(rows.profile);
  return std::move(rows.profile);
}

}  // namespace facula
