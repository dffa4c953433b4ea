// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/capture/capture.hpp>
#include <facula/acquire/stripe/stripe_detector.hpp>

namespace facula {

/// Measures a stripe against the bare bed: position := bed_position + (position - reference) -
/// shift, where `reference` is the same axis position of the run over the bare bed and shift is the
/// median of (position - reference) over the bed rows, which the stage's play between the two runs
/// leaves. The reference is smoothed along the line by a robust parabola, since the bed is flat; it
/// stands in for rows in which the reference was not seen. Sigma stays that of the run: parabola
/// and shift are means over many rows. Returns the shift [px]. Throws Error when the two differ in
/// size, the reference is seen in fewer than 20 rows, or the run in fewer than 20 bed rows.
double measure_against_bed(const ZeroLine& zero_line,
                           const StripeProfile& reference,
                           StripeProfile& profile);

}  // namespace facula
