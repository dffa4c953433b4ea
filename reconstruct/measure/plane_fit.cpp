// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/reconstruct/measure/bounding_rectangle.hpp>
#include <facula/reconstruct/measure/plane.hpp>

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

namespace facula {
namespace {

struct Moments {
  std::size_t count = 0;
  Eigen::Vector3d centroid = Eigen::Vector3d::Zero();
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();  ///< about the centroid
  double mean_range = 0;
};

Moments moments_of(const PointCloud& cloud) {
  Moments m;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (!cloud.points[i].allFinite()) continue;
    const Eigen::Vector3d x = cloud.points[i].cast<double>();
    const Eigen::Vector3d eye = cloud.sensor_origin.empty()
                                    ? Eigen::Vector3d::Zero()
                                    : Eigen::Vector3d(cloud.sensor_origin[i].cast<double>());
    m.centroid += x;
    m.mean_range += (x - eye).norm();
    ++m.count;
  }
  require(m.count >= 3, "a plane needs at least 3 points, the cloud has ", m.count);
  m.centroid /= static_cast<double>(m.count);
  m.mean_range /= static_cast<double>(m.count);
  for (const Eigen::Vector3f& p : cloud.points) {
    if (!p.allFinite()) continue;
    const Eigen::Vector3d d = p.cast<double>() - m.centroid;
    m.scatter += d * d.transpose();
  }
  return m;
}

/// The figures that need a second look at every point.
void describe_distances(const PointCloud& cloud, PlaneFit& fit) {
  double least = INFINITY;
  double most = -INFINITY;
  double squares = 0;
  double sizes = 0;
  for (const Eigen::Vector3f& p : cloud.points) {
    if (!p.allFinite()) continue;
    const double d = fit.plane.normal.dot(p.cast<double>() - fit.centroid);
    least = std::min(least, d);
    most = std::max(most, d);
    squares += d * d;
    sizes += std::abs(d);
  }
  const double n = static_cast<double>(fit.points);
  fit.rms = fit.points > 3 ? std::sqrt(squares / (n - 3)) : 0;
  fit.mean_absolute = sizes / n;
  fit.peak_to_valley = most - least;
}

void describe_extent(const PointCloud& cloud, const Eigen::Vector3d& along, PlaneFit& fit) {
  const Eigen::Vector3d across = fit.plane.normal.cross(along);
  std::vector<Eigen::Vector2d> flat;
  flat.reserve(cloud.size());
  for (const Eigen::Vector3f& p : cloud.points) {
    if (!p.allFinite()) continue;
    const Eigen::Vector3d d = p.cast<double>() - fit.centroid;
    flat.emplace_back(d.dot(along), d.dot(across));
  }
  const RectangleSides sides = smallest_bounding_rectangle(std::move(flat));
  fit.extent = sides.longer;
  fit.width = sides.shorter;
}

}  // namespace

PlaneFit fit_plane(const PointCloud& cloud) {
  cloud.check();
  const Moments m = moments_of(cloud);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(m.scatter);
  const Eigen::Vector3d& spread = solver.eigenvalues();
  require(spread(1) > 1e-10 * spread(2),
          "the ",
          m.count,
          " points lie on one line or in one spot, so they decide no plane; add points beside it");

  PlaneFit fit;
  fit.points = m.count;
  fit.centroid = m.centroid;
  fit.plane.normal = solver.eigenvectors().col(0).normalized();
  fit.plane.distance = fit.plane.normal.dot(m.centroid);
  if (fit.plane.distance < 0) fit.plane = {-fit.plane.normal, -fit.plane.distance};
  describe_distances(cloud, fit);
  describe_extent(cloud, solver.eigenvectors().col(2), fit);
  fit.mean_range = m.mean_range;
  fit.system_error = m.mean_range > 0 ? 4 * fit.rms / m.mean_range : 0;
  // To first order the normal tilts along a principal axis by sum(s d) / sum(s^2), s the position
  // along it and d the noise: variance rms^2 / eigenvalue, worst along the shorter axis.
  fit.normal_sigma = fit.rms / std::sqrt(spread(1));
  fit.distance_sigma = fit.rms / std::sqrt(static_cast<double>(m.count));
  return fit;
}

double angle_between(const Plane& a, const Plane& b) {
  // atan2 keeps its digits near 0, where acos loses them.
  return std::atan2(a.normal.cross(b.normal).norm(), std::abs(a.normal.dot(b.normal)));
}

double distance_between(const PlaneFit& a, const PlaneFit& b) {
  return std::abs(a.plane.signed_distance(b.centroid));
}

}  // namespace facula
