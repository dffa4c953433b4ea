// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

namespace facula {

/// Direct calibration (source D, III.1): size or height as a polynomial of the stripe's position.
/// Powers are taken of t = (px - centre) / scale, which keeps their numbers of one size.
struct ProfilePolynomial {
  std::vector<double> coefficients;  ///< of t^0, t^1, ... [m]
  double centre = 0;                 ///< [px]
  double scale = 1;                  ///< [px]
  double lowest_px = 0;              ///< positions between which it was fitted [px]
  double highest_px = 0;             ///< [px]

  int degree() const { return static_cast<int>(coefficients.size()) - 1; }

  /// [m]
  double value(double px) const;

  /// d value / d px [m/px].
  double slope(double px) const;

  /// A polynomial says nothing outside the positions it was fitted to.
  bool extrapolates(double px) const { return px < lowest_px || px > highest_px; }

  /// The same polynomial in plain powers of px, lowest first [m/px^i].
  std::vector<double> plain_coefficients() const;

  /// Throws Error on no coefficients, values that are not finite, or an empty range.
  void check() const;
};

}  // namespace facula
