// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/parallel.hpp>
#include <facula/reconstruct/measure/principal_frame.hpp>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

namespace facula {
namespace {

constexpr std::size_t kChunk = 16384;

/// Sums of offsets from a base point and of their products.
struct Moments {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Matrix3d products = Eigen::Matrix3d::Zero();
};

Moments moments_about(const Eigen::Vector3d& base,
                      const std::vector<Eigen::Vector3d>& points,
                      int num_threads) {
  const auto map = [&](std::size_t begin, std::size_t end) {
    Moments part;
    for (std::size_t i = begin; i < end; ++i) {
      const Eigen::Vector3d d = points[i] - base;
      part.sum += d;
      part.products += d * d.transpose();
    }
    return part;
  };
  const auto combine = [](const Moments& a, const Moments& b) {
    return Moments{a.sum + b.sum, a.products + b.products};
  };
  return parallel_reduce(
      points.size(), Moments{}, map, combine, {.num_threads = num_threads, .chunk = kChunk});
}

}  // namespace

PrincipalFrame principal_frame(const std::vector<Eigen::Vector3d>& points, int num_threads) {
  require(!points.empty(), "expected points, got none");
  const double n = static_cast<double>(points.size());
  // First about any point, for the mean; then about the mean, which keeps the small axis's digits.
  const Moments rough = moments_about(points.front(), points, num_threads);
  require(rough.products.allFinite(),
          "expected finite points, got coordinates that are not; filter them out first");
  PrincipalFrame frame;
  frame.origin = points.front() + rough.sum / n;
  const Moments moments = moments_about(frame.origin, points, num_threads);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(moments.products / n);
  frame.axes.row(0) = solver.eigenvectors().col(2).transpose();
  frame.axes.row(1) = solver.eigenvectors().col(1).transpose();
  frame.axes.row(2) = frame.axes.row(0).cross(frame.axes.row(1));
  frame.mean_squares = solver.eigenvalues().reverse().cwiseMax(0);
  return frame;
}

bool spans_surface(const PointCloud& cloud) {
  std::vector<Eigen::Vector3d> points;
  for (const Eigen::Vector3f& p : cloud.points) {
    if (p.allFinite()) points.push_back(p.cast<double>());
  }
  if (points.size() < 3) return false;
  constexpr double kThin = 1e-12;  // squared breadth over squared length: rounding, no surface
  const Eigen::Vector3d spread = principal_frame(points).mean_squares;
  return spread(1) > kThin * spread(0);
}

}  // namespace facula
