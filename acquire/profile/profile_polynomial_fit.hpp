// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/profile/profile_polynomial.hpp>

#include <optional>
#include <string>
#include <vector>

namespace facula {

/// A test piece of known size (or height) and where its line was seen.
struct ProfilePoint {
  double px = 0;    ///< [px]
  double size = 0;  ///< [m]
};

struct ProfilePolynomialOptions {
  std::optional<int> degree;  ///< absent: chosen by leave-one-out [1]
  int max_degree = 6;         ///< of the choice [1]
  void check() const;
};

/// How one degree does.
struct PolynomialTrial {
  int degree = 0;
  double rms = 0;           ///< of the fit's own residual [m]
  double held_out_rms = 0;  ///< leave-one-out error [m]
};

struct ProfilePolynomialFit {
  ProfilePolynomial polynomial;
  std::vector<double> residual;         ///< modelled - actual size, per point [m]
  std::vector<double> held_out;         ///< the same from the fit without the point [m]
  double rms = 0;                       ///< [m]
  double held_out_rms = 0;              ///< [m]
  std::vector<PolynomialTrial> trials;  ///< every degree that the points allow
  std::vector<std::string> warnings;
};

/// Least squares over the sizes. The degree chosen is the lowest whose leave-one-out error is
/// within a standard error of the best. Throws Error when a value is not finite, the degree asks
/// for more different positions than there are (one is kept to check by), or all positions are
/// equal.
ProfilePolynomialFit fit_profile_polynomial(const std::vector<ProfilePoint>& points,
                                            const ProfilePolynomialOptions& options = {});

}  // namespace facula
