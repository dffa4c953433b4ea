// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/point_cloud.hpp>
#include <facula/reconstruct/measure/primitive_fit.hpp>

#include <cstddef>
#include <limits>
#include <vector>

#include <Eigen/Core>

namespace facula {

struct Sphere {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  ///< [m]
  double radius = 1;                                 ///< [m]

  double signed_distance(const Eigen::Vector3d& x) const { return (x - center).norm() - radius; }
};

struct SphereFit {
  Sphere sphere;
  double radius_sigma = 0;                                      ///< 1 standard deviation [m]
  Eigen::Matrix3d center_covariance = Eigen::Matrix3d::Zero();  ///< [m^2]
  PrimitiveQuality quality;  ///< covariance of (center x, y, z, radius)
};

/// Geometric least squares: the distances from the surface are least. Starts from the algebraic
/// fit. Needs four points that do not lie in one plane; throws Error otherwise.
SphereFit fit_sphere(const PointCloud& cloud,
                     const std::vector<std::size_t>& indices,
                     const PrimitiveFitOptions& options = {});

/// How shapes are sought among other points.
struct ShapeSearchOptions {
  double inlier_distance = 0.002;  ///< farthest point of the shape [m], above 0
  double min_radius = 0;           ///< [m]
  double max_radius = std::numeric_limits<double>::infinity();  ///< [m]
  std::size_t min_points = 50;                                  ///< smallest shape [1]
  int trials = 2000;                                            ///< at most [1]
  unsigned seed = 1;                                            ///< [1]

  void check() const;

  /// Throws Error when the best `shape` has `found` of the cloud's `points`, fewer than min_points.
  void require_found(const char* shape, std::size_t found, std::size_t points) const;
};

/// How far from a fitted shape its points may lie: the inlier distance, or 5 robust standard
/// deviations of the distances where that is less. What touches a shape lies within the first and
/// would bend it.
double trimmed_distance(std::vector<double> distances, double inlier_distance);

struct FoundSphere {
  SphereFit fit;
  std::vector<std::size_t> indices;  ///< of the cloud's points on it
};

/// The sphere with most points on it by RANSAC (Fischler and Bolles 1981) over four points a try,
/// judged by 5000 points drawn from the cloud, then least squares over its points. The same seed
/// gives the same sphere. Throws Error when none has min_points.
FoundSphere find_sphere(const PointCloud& cloud, const ShapeSearchOptions& options = {});

}  // namespace facula
