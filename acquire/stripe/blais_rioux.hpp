// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/stripe/row_detector.hpp>

#include <memory>

namespace facula {

/// Zero crossing of the sum of `taps` pixels, half of them to the left less half to the right of
/// the pixel itself, linear between two pixels (Blais and Rioux, Signal Processing 11, 1986: orders
/// 4 and 8). 4 taps suit lines of up to 1.5 px, 8 wider ones. sigma: the sums gl, gr left and right
/// of the crossing with t = gl / (gl - gr) move it by ((1 - t) dgl + t dgr) / (gl - gr); what the
/// straight line between them leaves of a Gaussian, RMS over the pixel, is sigma_step. Throws Error
/// for an odd or negative number of taps. `sigma` is the width looked for [px].
std::unique_ptr<RowDetector> make_blais_rioux(double sigma, int taps);

}  // namespace facula
