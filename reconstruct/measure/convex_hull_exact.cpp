// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/reconstruct/measure/convex_hull_exact.hpp>

#include <array>
#include <cmath>
#include <cstddef>

#include <Eigen/Geometry>

namespace facula {
namespace {

constexpr double kRounding = 1.1102230246251565e-16;  // 2^-53

/// A sum of doubles without rounding: parts that do not overlap, smallest first (Shewchuk 1997,
/// GROW-EXPANSION). Six products of three differences of two parts each make 192 terms at most.
class ExactTotal {
 public:
  void add(double value) {
    if (value == 0) return;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < size_; ++i) {
      const ExactPair sum = exact_sum(value, parts_[i]);
      if (sum.low != 0) parts_[kept++] = sum.low;
      value = sum.high;
    }
    if (value != 0) parts_[kept++] = value;
    size_ = kept;
  }

  int sign() const {
    if (size_ == 0) return 0;
    return parts_[size_ - 1] > 0 ? 1 : -1;
  }

 private:
  std::array<double, 200> parts_{};
  std::size_t size_ = 0;
};

void add_product(ExactTotal& total, double a, double b, double c) {
  if (a == 0 || b == 0 || c == 0) return;
  const ExactPair ab = exact_product(a, b);
  for (const double factor : {ab.high, ab.low}) {
    if (factor == 0) continue;
    const ExactPair abc = exact_product(factor, c);
    total.add(abc.low);
    total.add(abc.high);
  }
}

/// Adds the exact a b c of three exact differences.
void add_product(ExactTotal& total, const ExactPair& a, const ExactPair& b, const ExactPair& c) {
  for (const double x : {a.high, a.low}) {
    for (const double y : {b.high, b.low}) {
      add_product(total, x, y, c.low);
      add_product(total, x, y, c.high);
    }
  }
}

using ExactVector = std::array<ExactPair, 3>;

ExactVector exact_vector(const Eigen::Vector3d& to, const Eigen::Vector3d& from) {
  return {exact_difference(to.x(), from.x()),
          exact_difference(to.y(), from.y()),
          exact_difference(to.z(), from.z())};
}

ExactPair negative(const ExactPair& a) {
  return {-a.high, -a.low};
}

int exact_side(const ExactVector& u, const ExactVector& v, const ExactVector& w) {
  ExactTotal total;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    const std::size_t k = (i + 2) % 3;
    add_product(total, u[i], v[j], w[k]);
    add_product(total, negative(u[i]), v[k], w[j]);
  }
  return total.sign();
}

}  // namespace

int side_of_plane(const Eigen::Vector3d& a,
                  const Eigen::Vector3d& b,
                  const Eigen::Vector3d& c,
                  const Eigen::Vector3d& x) {
  const Eigen::Vector3d u = b - a;
  const Eigen::Vector3d v = c - a;
  const Eigen::Vector3d w = x - a;
  const double determinant = w.dot(u.cross(v));
  const Eigen::Vector3d p = u.cwiseAbs();
  const Eigen::Vector3d q = v.cwiseAbs();
  const Eigen::Vector3d r = w.cwiseAbs();
  const double permanent = r.x() * (p.y() * q.z() + p.z() * q.y()) +
                           r.y() * (p.z() * q.x() + p.x() * q.z()) +
                           r.z() * (p.x() * q.y() + p.y() * q.x());
  if (std::abs(determinant) > 16 * kRounding * permanent) return determinant > 0 ? 1 : -1;
  return exact_side(exact_vector(b, a), exact_vector(c, a), exact_vector(x, a));
}

bool on_one_line(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  const ExactVector u = exact_vector(b, a);
  const ExactVector v = exact_vector(c, a);
  constexpr ExactPair kOne{1, 0};
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    ExactTotal total;
    add_product(total, u[i], v[j], kOne);
    add_product(total, negative(u[j]), v[i], kOne);
    if (total.sign() != 0) return false;
  }
  return true;
}

}  // namespace facula
