// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/stripe/stripe_candidate.hpp>
#include <facula/acquire/stripe/stripe_signal.hpp>

#include <optional>

namespace facula {

/// Where a profile rises through a level on its left and falls through it on its right, linear
/// between two pixels, and how steep it is there.
struct Crossings {
  double left = 0;         ///< [px]
  double right = 0;        ///< [px]
  double left_slope = 0;   ///< upwards, above 0 [DN/px]
  double right_slope = 0;  ///< downwards, above 0 [DN/px]
};

/// What can be read off a profile without a model: its top and the level beside it.
struct PeakShape {
  int first = 0;             ///< first brightest pixel [px]
  int last = 0;              ///< last brightest pixel [px]
  int top = 0;               ///< value there [DN]
  double background = 0;     ///< mean beside the stripe, 4 to 6 sigma off [DN]
  int background_count = 0;  ///< pixels in that mean

  /// The middle of the brightest pixels (source B, 2.3), to a whole pixel.
  int middle() const { return (first + last) / 2; }
  double height() const { return top - background; }
};

/// The brightest pixels within 1.5 sigma (at least 2 px) of `peak`, followed outwards as long as
/// they go on; none where nothing rises over the surroundings. `sigma` is the width looked for
/// [px].
std::optional<PeakShape> peak_shape(const SignalRow& row, int peak, double sigma);

/// Nearest crossings of background + share * height on both sides of the top; none where the row
/// ends before the profile has come down.
std::optional<Crossings> crossings(const SignalRow& row, const PeakShape& shape, double share);

/// A candidate with amplitude (brightest pixel), background, width (from the half height: full
/// width over 2.3548), misfit and clipping filled; its position is the top's middle. None where the
/// profile does not come down to its half within the row.
std::optional<StripeCandidate> describe_peak(const SignalRow& row, const PeakShape& shape);

/// Mean square that a Gaussian line leaves over +-3 widths about the candidate, after level,
/// height, place and width were fitted to first order (Gauss-Newton, one step): misplacing the
/// candidate by part of a pixel does not count as misfit. Looks at most `most_reach` px to both
/// sides.
void measure_misfit(const SignalRow& row, StripeCandidate& found, double most_reach = 1e6);

}  // namespace facula
