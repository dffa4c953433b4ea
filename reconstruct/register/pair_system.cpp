// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/median.hpp>
#include <facula/acquire/core/parallel.hpp>
#include <facula/reconstruct/register/pair_system.hpp>

#include <algorithm>
#include <cmath>

namespace facula {
namespace {

/// Standard deviation of the residuals by their median, for normal ones.
double robust_scale(const std::vector<PointPair>& pairs) {
  std::vector<double> sizes;
  sizes.reserve(pairs.size());
  for (const PointPair& pair : pairs) sizes.push_back(std::abs(pair.residual));
  return std::max(1.4826 * median(sizes), 1e-6);
}

void find_pivot(const std::vector<PointPair>& pairs, PairSystem& system) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const PointPair& pair : pairs) sum += pair.point;
  const double n = static_cast<double>(pairs.size());
  system.pivot = sum / n;
  double squares = 0;
  for (const PointPair& pair : pairs) squares += (pair.point - system.pivot).squaredNorm();
  system.radius = std::max(std::sqrt(squares / n), 1e-9);
}

struct Sums {
  Matrix6 hessian = Matrix6::Zero();
  Vector6 gradient = Vector6::Zero();
  Matrix6 shape = Matrix6::Zero();
  double weight = 0;
};

Sums operator+(Sums a, const Sums& b) {
  a.hessian += b.hessian;
  a.gradient += b.gradient;
  a.shape += b.shape;
  a.weight += b.weight;
  return a;
}

void add(const PointPair& pair, const PairSystem& system, double weight, Sums& sums) {
  const Eigen::Vector3d arm = pair.point - system.pivot;
  const Eigen::Matrix<double, 3, 6> j = pose_jacobian(arm);
  const Eigen::Matrix<double, 3, 6> wj = weight * pair.weight * j;
  sums.hessian.noalias() += j.transpose() * wj;
  sums.gradient.noalias() += wj.transpose() * pair.offset;
  Vector6 a;
  Vector6 b;
  a << pair.source_normal, arm.cross(pair.source_normal) / system.radius;
  b << pair.target_normal, arm.cross(pair.target_normal) / system.radius;
  sums.shape.noalias() += weight * a * b.transpose();
  sums.weight += weight;
}

}  // namespace

PairSystem assemble(const std::vector<PointPair>& pairs, const PairOptions& options) {
  PairSystem system;
  system.scale = robust_scale(pairs);
  find_pivot(pairs, system);
  const auto map = [&](std::size_t begin, std::size_t end) {
    Sums sums;
    for (std::size_t i = begin; i < end; ++i) {
      const double u = pairs[i].residual / system.scale;
      add(pairs[i], system, robust_weight(options.kernel, u).weight, sums);
    }
    return sums;
  };
  const auto combine = [](const Sums& a, const Sums& b) { return a + b; };
  const Sums sums = parallel_reduce(
      pairs.size(), Sums{}, map, combine, {.num_threads = options.num_threads, .chunk = 512});
  system.hessian = sums.hessian;
  system.gradient = sums.gradient;
  system.shape = (sums.shape + sums.shape.transpose()) / (2 * std::max(sums.weight, 1e-9));
  return system;
}

}  // namespace facula
