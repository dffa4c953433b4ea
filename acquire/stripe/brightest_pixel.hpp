// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/stripe/row_detector.hpp>

#include <memory>

namespace facula {

/// The middle of the brightest pixels, to a whole pixel (source B, 2.2: "the simplest method"). Its
/// error is that of rounding, 1/sqrt(12) px, and of noise n that makes a neighbour the brightest:
/// the pixel beside the top is lower by delta A / w^2, delta the distance from the tie, so it wins
/// with probability Q(delta A / (sqrt(2) n w^2)) at the cost of 2 delta, which integrates to a
/// variance of 2 (n w^2 / A)^2 for noise that is small against A / w^2. `sigma` is the width looked
/// for [px].
std::unique_ptr<RowDetector> make_brightest_pixel(double sigma);

/// The same to half a pixel (an even number of brightest pixels has its middle between two), and
/// only where the top stands at least `threshold` over its surroundings [DN]; the intensity is the
/// top itself (source D: "horizontal maximum and thresholding").
std::unique_ptr<RowDetector> make_maximum_threshold(double sigma, double threshold);

}  // namespace facula
