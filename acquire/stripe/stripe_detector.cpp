// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/median.hpp>
#include <facula/acquire/stripe/detector_table.hpp>
#include <facula/acquire/stripe/line_kernels.hpp>
#include <facula/acquire/stripe/locate.hpp>
#include <facula/acquire/stripe/row_noise.hpp>
#include <facula/acquire/stripe/stripe_detector.hpp>
#include <facula/acquire/stripe/stripe_location.hpp>
#include <facula/acquire/stripe/stripe_median.hpp>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

namespace facula {
namespace {

/// Rows [first, last) and, within a row, columns [begin, end) that are searched.
struct SearchArea {
  int first = 0;
  int last = 0;
  int begin = 0;
  int end = 0;
};

SearchArea search_area(const StripeSignal& signal, const StripeOptions& options) {
  const bool transposed = options.direction == StripeDirection::kPerColumn;
  const ImageRegion& region = options.region;
  const int first = transposed ? region.x : region.y;
  const int begin = transposed ? region.y : region.x;
  const int rows = transposed ? region.width : region.height;
  const int cols = transposed ? region.height : region.width;
  SearchArea area;
  area.first = std::clamp(first, 0, signal.rows());
  area.last = rows > 0 ? std::clamp(first + rows, area.first, signal.rows()) : signal.rows();
  area.begin = std::clamp(begin, 0, signal.cols());
  area.end = cols > 0 ? std::clamp(begin + cols, area.begin, signal.cols()) : signal.cols();
  return area;
}

using Candidates = std::vector<std::optional<StripeCandidate>>;

/// The frame's noise, or the row's own where that is clearly larger: one row is a small sample.
float noise_about(const StripeCandidate& found, float frame_noise) {
  return found.row_noise > 1.5F * frame_noise ? found.row_noise : frame_noise;
}

bool stands_out(const StripeCandidate& found, float noise, const StripeOptions& options) {
  const double row_noise = static_cast<double>(noise_about(found, noise));
  return static_cast<double>(found.snr_per_noise) >= options.min_snr * row_noise &&
         static_cast<double>(found.amplitude) >= options.min_amplitude &&
         static_cast<double>(found.width) <= options.max_width_ratio * options.sigma;
}

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

// Median over mean of a sum of about 8 independent squares (Wilson and Hilferty 1931): a residual
// is what some 9 pixels leave, of which the outer ones count less.
constexpr float kMedianOfSquares = 0.92F;

/// How the variance grows with the signal (photon noise, speckle): the median over the stripes of
/// (misfit - noise^2) over the mean signal under it, at least 0 [DN]. Clipped stripes say nothing
/// about it.
float signal_noise_gain(const Candidates& candidates, float noise) {
  std::vector<float> gains;
  for (const auto& found : candidates) {
    if (found && !found->saturated && found->amplitude > 0 && found->residual_share > 0) {
      gains.push_back((found->residual / kMedianOfSquares - noise * noise) /
                      (found->amplitude * found->residual_share));
    }
  }
  if (gains.size() < 16) return 0;
  return std::max(0.0F, median(gains));
}

constexpr float kLeastMisfit = 2.5F;  // over the expected mean square: beyond chance for 9 pixels

void store(const StripeCandidate& found, float gain, std::size_t r, StripeProfile& profile) {
  const float noise = noise_about(found, profile.noise);
  const float photons = gain * found.amplitude;
  const float expected = noise * noise + photons * found.residual_share;
  float variance = noise * noise + photons * found.position_share;
  // A profile that is no single Gaussian (a depth edge cuts it, two surfaces share it) says so by
  // its misfit; the position is then uncertain in the same measure.
  if (!found.saturated && found.residual > kLeastMisfit * expected) {
    variance = std::max(variance, found.residual);
  }
  profile.seen[r] = 1;
  profile.position[r] = found.position;
  profile.sigma[r] = std::hypot(found.sigma_per_noise * std::sqrt(variance), found.sigma_step);
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

StripeLocation StripeLocation::none(std::size_t rows) {
  StripeLocation location;
  location.peak.assign(rows, -1);
  location.peak_per_noise.assign(rows, 0);
  location.row_noise.assign(rows, 0);
  return location;
}

StripeLocation locate_stripe(const StripeSignal& signal, const StripeOptions& options) {
  StripeLocation location = StripeLocation::none(static_cast<std::size_t>(signal.rows()));
  location.noise = estimate_noise(signal);
  const LineKernels kernels = line_kernels(options.sigma);
  const SearchArea area = search_area(signal, options);
  for (int r = area.first; r < area.last; ++r) {
    const LocatedRow located = locate_in_row(signal.row(r), kernels, area.begin, area.end, 1);
    if (located.peaks.empty()) continue;
    const auto i = static_cast<std::size_t>(r);
    location.peak[i] = located.peaks.front().column;
    location.peak_per_noise[i] = located.peaks.front().response / kernels.curvature_norm;
    location.row_noise[i] = located.row_noise;
  }
  return location;
}

StripeProfile measure_stripe(const StripeSignal& signal,
                             const StripeLocation& location,
                             const StripeOptions& options) {
  const std::unique_ptr<RowDetector> detector = make_detector(options);
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
  const StripeSignal signal(
      frame, background, options.channel, options.direction == StripeDirection::kPerColumn);
  return measure_stripe(signal, locate_stripe(signal, options), options);
}

}  // namespace facula
