// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/stripe/row_detector.hpp>

#include <memory>

namespace facula {

/// A parabola fitted by least squares to ln I over +-1.5 widths (Caruana et al. 1986), the pixels
/// weighted by the square of their height since ln I is known to n / I; then once more with the
/// heights of the first fit as weights (Guo, IEEE Signal Processing Magazine 28(5), 2011, (9)).
/// Clipped pixels and those not above the surroundings are left out, so a clipped line is found by
/// its flanks. sigma: with X the rows (1, x, x^2), M = (X' W X)^-1 and W = diag(I^2), a pixel moves
/// the coefficients by M X_i I_i and the top -c1 / (2 c2) accordingly. `sigma` is the width looked
/// for [px].
std::unique_ptr<RowDetector> make_log_gauss(double sigma);

}  // namespace facula
