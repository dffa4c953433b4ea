// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/stripe/candidate_judgement.hpp>
#include <facula/acquire/stripe/detector_table.hpp>
#include <facula/acquire/stripe/exact_misfit.hpp>
#include <facula/acquire/stripe/line_kernels.hpp>
#include <facula/acquire/stripe/locate.hpp>
#include <facula/acquire/stripe/row_noise.hpp>
#include <facula/acquire/stripe/stripe_choice.hpp>
#include <facula/acquire/stripe/stripe_detector.hpp>
#include <facula/acquire/stripe/stripe_judge.hpp>
#include <facula/acquire/stripe/stripe_location.hpp>
#include <facula/acquire/stripe/stripe_median.hpp>
#include <facula/acquire/stripe/stripe_sigma.hpp>
#include <facula/acquire/stripe/stripe_simd.hpp>
#include <facula/acquire/stripe/transposed.hpp>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

namespace facula {
namespace {

using Candidates = std::vector<std::optional<StripeCandidate>>;

/// Clears candidates that do not hang together with their neighbours over options.min_run rows: a
/// line goes on from row to row, grain and sparks do not. A run may skip up to two rows.
void drop_short_runs(Candidates& candidates, const StripeOptions& options) {
  const double max_step = 4 * options.sigma + 2;
  std::vector<std::size_t> run;
  const auto end_run = [&] {
    if (run.size() < static_cast<std::size_t>(options.min_run)) {
      for (const std::size_t r : run) candidates[r].reset();
    }
    run.clear();
  };
  for (std::size_t r = 0; r < candidates.size(); ++r) {
    if (!candidates[r]) continue;
    const bool goes_on =
        !run.empty() && r - run.back() <= 3 &&
        std::abs(static_cast<double>(candidates[r]->position - candidates[run.back()]->position)) <=
            max_step * static_cast<double>(r - run.back());
    if (!goes_on) end_run();
    run.push_back(r);
  }
  end_run();
}

MeasuredRows measure_all(const StripeSignal& signal,
                         const StripeLocation& location,
                         const RowDetector& detector) {
  MeasuredRows rows(location.size(), location.noise);
  for (std::size_t r = 0; r < location.size(); ++r) {
    rows.set(r, {});
    rows.profile.seen[r] = 0;
    const int peak = location.peak[r];
    if (peak < 0 || !signal.row(static_cast<int>(r)).holds(peak)) continue;
    auto found = detector.measure(signal, static_cast<int>(r), peak);
    if (!found) continue;
    found->row_noise = location.row_noise[r];
    rows.set(r, *found);
  }
  return rows;
}

StripeProfile judge_fir(MeasuredRows rows, const StripeOptions& options, RowAbout row_about) {
  StripeProfile profile =
      judge_rows(std::move(rows), options, ExactMisfit(std::move(row_about), options.sigma));
  if (options.median_rows == 3) median_along(profile, false);
  return profile;
}

std::optional<StripeProfile> detect_upright(const StripeView& view, const StripeOptions& options) {
  auto rows = measure_frame_simd(view, options, nullptr);
  if (!rows) return {};
  return judge_fir(
      std::move(*rows), options, rows_of(view.frame, view.background, options.channel));
}

/// The shortest way, for the default detector: straight on the frame.
std::optional<StripeProfile> detect_in_frame(ImageView8 frame,
                                             ImageView8 background,
                                             const StripeOptions& options) {
  if (options.detector != DetectorKind::kFirZeroCrossing) return {};
  check_pair(frame, background);
  if (options.direction == StripeDirection::kPerColumn) {
    const Image8 turned = transposed(frame);
    const Image8 turned_dark = background.empty() ? Image8() : transposed(background);
    return detect_upright({turned.view(), turned_dark.view()}, options);
  }
  return detect_upright({frame, background}, options);
}

void store(const StripeCandidate& found, float gain, std::size_t r, StripeProfile& profile) {
  profile.seen[r] = 1;
  profile.position[r] = found.position;
  profile.sigma[r] = position_sigma(found, profile.noise, gain);
  profile.amplitude[r] = found.amplitude;
  profile.width[r] = found.width;
  profile.saturated[r] = found.saturated ? 1 : 0;
}

}  // namespace

void StripeOptions::check() const {
  require(sigma >= 0.5 && sigma <= 10, "stripe sigma_px: expected 0.5 to 10, got ", sigma);
  require(min_snr > 0 && min_snr < 1e6,
          "stripe min_snr: expected above 0 and below 1e6, got ",
          min_snr);
  require(min_amplitude >= 0 && min_amplitude <= 255,
          "stripe min_amplitude: expected 0 to 255, got ",
          min_amplitude);
  require(max_width_ratio > 1, "stripe max_width_ratio: expected above 1, got ", max_width_ratio);
  require(median_rows == 1 || median_rows == 3,
          "stripe median_rows: expected 1 (off) or 3, got ",
          median_rows);
  require(min_run >= 1, "stripe min_run: expected 1 or more, got ", min_run);
  require(max_candidates >= 1 && max_candidates <= 8,
          "stripe max_candidates: expected 1 to 8, got ",
          max_candidates);
  require(min_hue_share >= 0 && min_hue_share <= 1,
          "stripe min_hue_share: expected 0 to 1, got ",
          min_hue_share);
  require(region.x >= 0 && region.y >= 0 && region.width >= 0 && region.height >= 0,
          "stripe region_px: expected 0 or more, got [",
          region.x,
          ", ",
          region.y,
          ", ",
          region.width,
          ", ",
          region.height,
          "]");
}

StripeProfile StripeProfile::none(std::size_t rows) {
  StripeProfile profile;
  profile.seen.assign(rows, 0);
  profile.position.assign(rows, 0);
  profile.sigma.assign(rows, 0);
  profile.amplitude.assign(rows, 0);
  profile.width.assign(rows, 0);
  profile.saturated.assign(rows, 0);
  return profile;
}

std::size_t StripeProfile::seen_count() const {
  return static_cast<std::size_t>(std::count(seen.begin(), seen.end(), std::uint8_t{1}));
}

StripeProfile measure_stripe(const StripeSignal& signal,
                             const StripeLocation& location,
                             const StripeOptions& options) {
  const std::unique_ptr<RowDetector> detector = make_detector(options);
  if (options.detector == DetectorKind::kFirZeroCrossing) {
    auto rows = measure_rows_simd(signal, location, options);
    return judge_fir(rows ? std::move(*rows) : measure_all(signal, location, *detector),
                     options,
                     rows_of(signal));
  }
  StripeProfile profile = StripeProfile::none(location.size());
  profile.noise = location.noise;
  Candidates candidates(location.size());
  for (std::size_t r = 0; r < location.size(); ++r) {
    const int peak = location.peak[r];
    if (peak < 0 || !signal.row(static_cast<int>(r)).holds(peak)) continue;
    auto found = detector->measure(signal, static_cast<int>(r), peak);
    if (!found) continue;
    found->row_noise = location.row_noise[r];
    if (stands_out(*found, location.noise, options)) candidates[r] = found;
  }
  drop_short_runs(candidates, options);
  const float gain = signal_noise_gain(candidates, profile.noise);
  for (std::size_t r = 0; r < candidates.size(); ++r) {
    if (candidates[r]) store(*candidates[r], gain, r, profile);
  }
  if (options.median_rows == 3) median_along(profile, options.detector == DetectorKind::kSteger);
  return profile;
}

StripeProfile detect_stripe(ImageView8 frame, ImageView8 background, const StripeOptions& options) {
  options.check();
  require(!frame.empty(), "expected a frame with pixels, got an empty one");
  if (asks_for_choice(options)) return detect_stripe(StripeView{frame, background}, options);
  if (auto profile = detect_in_frame(frame, background, options)) return std::move(*profile);
  const StripeSignal signal(
      frame, background, options.channel, options.direction == StripeDirection::kPerColumn);
  return measure_stripe(signal, locate_stripe(signal, options), options);
}

}  // namespace facula
