// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/profile/profile_polynomial.hpp>

#include <cmath>
#include <cstddef>

namespace facula {

double ProfilePolynomial::value(double px) const {
  const double t = (px - centre) / scale;
  double sum = 0;
  for (std::size_t i = coefficients.size(); i-- > 0;) sum = sum * t + coefficients[i];
  return sum;
}

double ProfilePolynomial::slope(double px) const {
  const double t = (px - centre) / scale;
  double sum = 0;
  for (std::size_t i = coefficients.size(); i-- > 1;) {
    sum = sum * t + static_cast<double>(i) * coefficients[i];
  }
  return sum / scale;
}

std::vector<double> ProfilePolynomial::plain_coefficients() const {
  // Horner's scheme on polynomials: sum = sum * (px - centre) / scale + c_i.
  std::vector<double> sum;
  for (std::size_t i = coefficients.size(); i-- > 0;) {
    std::vector<double> next(sum.size() + 1, 0);
    for (std::size_t k = 0; k < sum.size(); ++k) {
      next[k + 1] += sum[k] / scale;
      next[k] -= sum[k] * centre / scale;
    }
    next[0] += coefficients[i];
    sum = std::move(next);
  }
  sum.resize(coefficients.size());
  return sum;
}

void ProfilePolynomial::check() const {
  require(!coefficients.empty(), "expected at least one coefficient of the profile polynomial");
  for (const double c : coefficients) {
    require(std::isfinite(c), "expected finite coefficients of the profile polynomial, got ", c);
  }
  require(std::isfinite(centre) && std::isfinite(scale) && scale > 0,
          "expected a finite centre and a scale above 0 px of the profile polynomial, got ",
          centre,
          " and ",
          scale);
  require(lowest_px < highest_px,
          "expected the profile polynomial's lowest position below its highest, got ",
          lowest_px,
          " and ",
          highest_px,
          " px");
}

}  // namespace facula
