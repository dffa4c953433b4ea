// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/stripe/row_detector.hpp>

#include <memory>

namespace facula {

/// The ridge of the frame smoothed by a round Gaussian of width `sigma` [px] (Steger, IEEE PAMI
/// 20(2), 1998, section 3.2): with gradient g and Hessian H at a pixel and n the direction of the
/// strongest bend, the ridge lies t n beside it, t = -(g n) / (n' H n); the ridge runs at right
/// angles to n, so it meets the pixel's own row t / n_x beside it. Rows beyond what is known are
/// taken like the nearest known.
///
/// It sees the light of 2 sqrt(pi) sigma rows, so it is quieter than any detector of single rows,
/// its errors in neighbouring rows go together, and depth steps within 2 sigma are rounded.
/// sigma: the noise of g n is that of one derivative times that of one smoothing, whatever n. The
/// Taylor expansion leaves p^3 / (w^2 + sigma^2) for a line of width w at p beside the pixel: 1 /
/// (8 sqrt(7)) of that, RMS over the pixel, is sigma_step.
std::unique_ptr<RowDetector> make_steger(double sigma);

}  // namespace facula
