// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/stripe/row_detector.hpp>

#include <memory>

namespace facula {

/// The top of the parabola through the brightest pixel b and its neighbours a, c (Naidu and Fisher,
/// BMVC 1991): (a - c) / (2 (a - 2 b + c)) beside the brightest. For a Gaussian of width w, u =
/// 1/w^2, a line p beside the brightest pixel is found at E sinh(pu) / (2 (1 - E cosh(pu))), E =
/// exp(-u/2): the RMS of that bias over the pixel is sigma_step. A clipped top has no parabola:
/// such rows are not seen. `sigma` is the width looked for [px].
std::unique_ptr<RowDetector> make_parabola(double sigma);

/// The top of the Gaussian through the same three pixels (Naidu and Fisher, 1991): the parabola
/// through ln a, ln b, ln c, each over the surroundings. Exact for a sampled Gaussian.
std::unique_ptr<RowDetector> make_gauss(double sigma);

}  // namespace facula
