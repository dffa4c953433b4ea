// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

namespace facula {

/// Two doubles whose sum is the exact value of an operation: `high` is its rounded result.
struct ExactPair {
  double high = 0;
  double low = 0;
};

/// a + b without loss (Knuth 1969).
inline ExactPair exact_sum(double a, double b) {
  const double sum = a + b;
  const double part = sum - a;
  return {sum, (a - (sum - part)) + (b - part)};
}

/// a - b without loss.
inline ExactPair exact_difference(double a, double b) {
  return exact_sum(a, -b);
}

/// a b without loss, as long as nothing over- or underflows (Dekker 1971).
inline ExactPair exact_product(double a, double b) {
  constexpr double kSplit = 134217729;  // 2^27 + 1
  const double wide_a = kSplit * a;
  const double wide_b = kSplit * b;
  const double a1 = wide_a - (wide_a - a);
  const double b1 = wide_b - (wide_b - b);
  const double a2 = a - a1;
  const double b2 = b - b1;
  const double product = a * b;
  return {product, a2 * b2 - (((product - a1 * b1) - a2 * b1) - a1 * b2)};
}

/// Sign (-1, 0, 1) of det(b - a, c - a, x - a), exact: 1 where x lies on the side of the plane
/// through a, b, c from which these run counter-clockwise. A filter in doubles decides the clear
/// cases; the rest is summed without rounding (after Shewchuk 1997). Coordinates of size 1e-80 to
/// 1e80, or 0.
int side_of_plane(const Eigen::Vector3d& a,
                  const Eigen::Vector3d& b,
                  const Eigen::Vector3d& c,
                  const Eigen::Vector3d& x);

/// Whether a, b and c lie on one line, exactly.
bool on_one_line(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c);

}  // namespace facula
