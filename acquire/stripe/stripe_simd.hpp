// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/stripe/stripe_choice.hpp>
#include <facula/acquire/stripe/stripe_judge.hpp>
#include <facula/acquire/stripe/stripe_location.hpp>
#include <facula/acquire/stripe/stripe_signal.hpp>

#include <optional>

namespace facula {

/// The default detector and the search that all detectors share, for many rows and columns at once
/// with the widest instructions the processor has. The numbers are those of estimate_noise(),
/// locate_stripe() and make_fir_zero_crossing(), bit for bit; see those for what they mean. Nothing
/// is returned for what these functions do not do, which the others then have to: lines of sigma
/// above 4 px, rows shorter than 64 px, a processor without the instructions.

/// All of it straight on a frame whose stripe runs across the rows, each pixel read once. The
/// location is also written to `location` unless that is null.
std::optional<MeasuredRows> measure_frame_simd(const StripeView& view,
                                               const StripeOptions& options,
                                               StripeLocation* location);

/// locate_stripe() on a whole frame's signal.
std::optional<StripeLocation> locate_stripe_simd(const StripeSignal& signal,
                                                 const StripeOptions& options);

/// The default detector on a frame's signal or on windows of it.
std::optional<MeasuredRows> measure_rows_simd(const StripeSignal& signal,
                                              const StripeLocation& location,
                                              const StripeOptions& options);

}  // namespace facula
