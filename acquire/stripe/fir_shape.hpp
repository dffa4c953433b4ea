// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/stripe/line_kernels.hpp>

#include <algorithm>

namespace facula {

/// The numbers that the default detector measures with; see fir_zero_crossing.hpp. The one that
/// measures a row and the one that measures many rows at once share them.
struct FirShape {
  WholeLineKernels kernels;
  float smooth_unit = 1;           ///< [1]
  float bend_unit = 1;             ///< [1]
  float sigma = 2;                 ///< of the filter [px]
  float sigma2 = 4;                ///< of the filter, squared [px^2]
  float least_width2 = 0.25F;      ///< of the line, squared, where its profile is drawn [px^2]
  float per_bend_noise = 1;        ///< 1 over the noise gain of the curvature [1]
  float slope_noise = 1;           ///< noise gain of the slope [1]
  int background_from = 8;         ///< columns off the peak on both sides [px]
  int background_to = 11;          ///< [px]
  float per_background_pixel = 1;  ///< [1]
  int misfit_reach = 6;            ///< columns off the peak where the profile is held up [px]
  float per_misfit_pixel = 1;      ///< [1]
  float per_misfit_freedom = 1;    ///< [1]

  /// Degrees of freedom of the misfit [1]: of its four parameters the width comes from the filters,
  /// not from a fit, and takes up 0.2 of one (3.03 to 3.23 in all for sigma 1 to 4, by Monte
  /// Carlo).
  float misfit_freedom() const { return static_cast<float>(2 * misfit_reach + 1) - 3.2F; }

  /// Farthest column off the peak that is read [px].
  int reach() const { return std::max({kernels.slope.radius() + 2, background_to, misfit_reach}); }
};

FirShape fir_shape(double sigma);

/// e^x to 1e-6 for |x| below 1, to 2e-4 up to 4 and to 1 % up to 8, where it stays: a polynomial
/// that is the same number wherever it is worked out.
inline float exp_near_zero(float x) {
  const float y = std::min(0.5F, std::max(-0.5F, x * 0.0625F));
  const float p = 1 + y * (1 + y * (0.5F + y * (1.0F / 6 + y * (1.0F / 24))));
  const float p2 = p * p;
  const float p4 = p2 * p2;
  const float p8 = p4 * p4;
  return p8 * p8;
}

}  // namespace facula
