// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/point_cloud.hpp>

#include <cstddef>
#include <vector>

#include <Eigen/Core>

namespace facula {

/// Points x with normal . x = distance.
struct Plane {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< unit length [1]
  double distance = 0;                                ///< from the frame's origin [m]

  double signed_distance(const Eigen::Vector3d& x) const { return normal.dot(x) - distance; }
};

/// A least-squares plane and how well the points lie on it.
struct PlaneFit {
  Plane plane;                                         ///< normal turned so that distance >= 0
  Eigen::Vector3d centroid = Eigen::Vector3d::Zero();  ///< [m]
  std::size_t points = 0;                              ///< [1]
  double rms = 0;             ///< standard deviation of the distances, n - 3 degrees of freedom [m]
  double mean_absolute = 0;   ///< mean |distance| (source C's "mean distance") [m]
  double peak_to_valley = 0;  ///< least-squares flatness: largest minus smallest distance [m]
  double extent = 0;          ///< longer side of the points' bounding box in the plane [m]
  double width = 0;           ///< shorter side [m]
  double mean_range = 0;      ///< mean distance D from the sensor [m]
  double system_error = 0;    ///< 4 sigma / D (source C) [1]
  double normal_sigma = 0;    ///< 1 standard deviation of the normal's direction, worst axis [rad]
  double distance_sigma = 0;  ///< 1 standard deviation of the distance at the centroid [m]
};

/// Orthogonal least squares over all points of the cloud. Needs three points or more that do not
/// lie on a line; throws Error otherwise.
PlaneFit fit_plane(const PointCloud& cloud);

/// Angle between two planes [rad], in [0, pi/2].
double angle_between(const Plane& a, const Plane& b);

/// Mean distance from b's points (its centroid) to plane a [m], unsigned.
double distance_between(const PlaneFit& a, const PlaneFit& b);

struct PlaneExtractionOptions {
  double inlier_distance = 0.01;  ///< farthest point of a plane [m], above 0
  std::size_t min_points = 500;   ///< smallest plane [1], at least 3
  int max_planes = 12;            ///< [1], at least 1
  int iterations = 2000;          ///< RANSAC trials per plane at most [1]
  unsigned seed = 1;              ///< [1]
  double max_gap = 0;  ///< parts of a surface nearer than this are one plane [m]; 0 = the larger of
                       ///< 2 inlier distances and 8 times the points' own spacing there
  double max_normal_angle = 0.6;  ///< between a point's normal and the plane's, if it has one [rad]

  void check() const;
};

struct ExtractedPlane {
  PlaneFit fit;
  std::vector<std::size_t> indices;  ///< of the cloud's points on this plane
};

/// Planes by RANSAC (Fischler and Bolles 1981), largest first, each refined by least squares over
/// the inliers of its largest connected piece. The same seed gives the same planes. Thin dense
/// clouds first, and choose inlier_distance at about three times the noise: below, a noisy surface
/// falls apart into slices.
std::vector<ExtractedPlane> extract_planes(const PointCloud& cloud,
                                           const PlaneExtractionOptions& options = {});

}  // namespace facula
