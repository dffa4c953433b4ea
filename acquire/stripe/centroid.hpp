// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/stripe/row_detector.hpp>

#include <memory>

namespace facula {

/// Source B's spot centre (2.3): the middle between the first and the last brightest pixel near the
/// place located, then the mean of I(x) x over +-10 px about it. I(x) is taken over the level
/// beside the stripe, since a pedestal left in the weights pulls the mean towards the window's
/// middle; a pixel below that level counts negative, so that noise pulls neither way.
///
/// sigma: a pixel moves the mean m by (x - m) / sum I; the level, a mean itself, moves it by the
/// sum of these. A wide line is cut by the window: with the window's middle up to half a pixel off,
/// the mean follows it by 2 h g(h), h = 10.5 px, g the normalised profile, uniformly (sigma_step).
/// `sigma` is the width looked for [px].
std::unique_ptr<RowDetector> make_centroid(double sigma);

/// Source D's centre of gravity ("high resolution range"): the unbroken run of pixels about the top
/// that stand more than `threshold` [DN] over their surroundings, each with the weight by which it
/// exceeds the threshold: a pixel that enters or leaves the run then has no weight, and the
/// position does not jump.
std::unique_ptr<RowDetector> make_threshold_centroid(double sigma, double threshold);

}  // namespace facula
