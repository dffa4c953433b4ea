// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/stripe/stripe_candidate.hpp>
#include <facula/acquire/stripe/stripe_signal.hpp>

namespace facula {

/// What a clipped core does to the uncertainty of a zero crossing found with a Gaussian derivative
/// k(x) = x / s^2 g(x) of width s = `sigma` [px]; `bend` D is how fast the response falls there
/// [DN/px^2].
///
/// The clip leaves kinks at +-h about the line's middle m, of slope K. Pixels sample them: by
/// Poisson's sum their first harmonic adds -K k(h) sin(2 pi h) sin(2 pi m) / pi^2 to the response,
/// which moves the crossing by that over D. h and K follow from the flanks, taken as a Gaussian's:
/// with heights v0 and v1 at x0 and x1, w^2 = (x1^2 - x0^2) / (2 ln(v0 / v1)), h^2 = x0^2 - 2 w^2
/// ln(C / v0) and K = C h / w^2, C the clipped height. The RMS over m is sigma_step, with h known
/// to a twentieth of a pixel.
///
/// Noise: clipped pixels have none. The derivative's square x^2 exp(-x^2 / s^2) has the share
/// erfc(z) + 2 z exp(-z^2) / sqrt(pi) beyond h, z = h / s; each side, with its own h, is half of
/// it.
void judge_clipped(const SignalRow& row, float sigma, float bend, StripeCandidate& found);

}  // namespace facula
