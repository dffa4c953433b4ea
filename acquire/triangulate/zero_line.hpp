// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/capture/capture.hpp>
#include <facula/acquire/stripe/stripe_detector.hpp>

namespace facula {

/// Measures a stripe against the bare bed: position := bed_position + (position - reference) -
/// shift, where `reference` is the same axis position of the run over the bare bed and shift is the
/// median of (position - reference) over the bed rows, which the stage's play between the two runs
/// leaves. The reference is smoothed along the line by a robust parabola, since the bed is flat.
/// Rows farther than the bed rows reach are treated alike. Returns the shift [px]. Throws Error
/// when fewer than 20 bed rows are seen in both.
double measure_against_bed(const ZeroLine& zero_line,
                           const StripeProfile& reference,
                           StripeProfile& profile);

}  // namespace facula
