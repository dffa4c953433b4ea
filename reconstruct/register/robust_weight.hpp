// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/reconstruct/register/pair_registration.hpp>

namespace facula {

/// A robust kernel at a residual: rho'(u) / u and rho''(u), where rho(u) = u^2 / 2 near 0.
struct RobustWeight {
  double weight = 1;  ///< of the residual in iteratively reweighted least squares [0..1]
  double slope = 1;   ///< change of weight * u by u; negative for gross outliers [1]
};

/// At u = residual / its standard deviation. The tuning constants give 95 % of the efficiency of
/// least squares on normal residuals (Huber 1.345, Cauchy 2.385, Tukey 4.685); Geman and McClure's
/// is 3, which rejects harder.
RobustWeight robust_weight(RobustKernel kernel, double u);

}  // namespace facula
