// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/reconstruct/measure/convex_hull_exact.hpp>

#include <cmath>

#include <Eigen/Core>

namespace facula {

/// A number of about 32 digits: the sum of two doubles that do not overlap (Dekker 1971).
class DoubleDouble {
 public:
  DoubleDouble() = default;
  explicit DoubleDouble(double value) : pair_{value, 0} {}
  explicit DoubleDouble(const ExactPair& pair) : pair_(pair) {}

  double value() const { return pair_.high; }

  friend DoubleDouble operator+(const DoubleDouble& a, const DoubleDouble& b) {
    const ExactPair high = exact_sum(a.pair_.high, b.pair_.high);
    const ExactPair low = exact_sum(a.pair_.low, b.pair_.low);
    const ExactPair first = exact_sum(high.high, high.low + low.high);
    return DoubleDouble(exact_sum(first.high, first.low + low.low));
  }
  friend DoubleDouble operator-(const DoubleDouble& a) {
    return DoubleDouble(ExactPair{-a.pair_.high, -a.pair_.low});
  }
  friend DoubleDouble operator-(const DoubleDouble& a, const DoubleDouble& b) { return a + (-b); }
  friend DoubleDouble operator*(const DoubleDouble& a, const DoubleDouble& b) {
    const ExactPair p = exact_product(a.pair_.high, b.pair_.high);
    return DoubleDouble(
        exact_sum(p.high, p.low + (a.pair_.high * b.pair_.low + a.pair_.low * b.pair_.high)));
  }
  friend bool operator<(const DoubleDouble& a, const DoubleDouble& b) {
    return (a - b).pair_.high < 0;
  }

 private:
  ExactPair pair_;
};

/// A vector of such numbers: only what widths need.
struct WideVector {
  DoubleDouble x, y, z;

  /// to - from without loss.
  static WideVector between(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
    return {DoubleDouble(exact_difference(to.x(), from.x())),
            DoubleDouble(exact_difference(to.y(), from.y())),
            DoubleDouble(exact_difference(to.z(), from.z()))};
  }

  WideVector cross(const WideVector& b) const {
    return {y * b.z - z * b.y, z * b.x - x * b.z, x * b.y - y * b.x};
  }
  DoubleDouble dot(const WideVector& b) const { return x * b.x + y * b.y + z * b.z; }
  WideVector operator-() const { return {-x, -y, -z}; }

  Eigen::Vector3d rounded() const { return {x.value(), y.value(), z.value()}; }
};

}  // namespace facula
