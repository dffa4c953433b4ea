// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/point_cloud.hpp>
#include <facula/acquire/core/scan_grid.hpp>

#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Core>

namespace facula {

/// Points x with normal . x = distance.
struct Plane {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< unit length [1]
  double distance = 0;                                ///< from the frame's origin [m]

  double signed_distance(const Eigen::Vector3d& x) const { return normal.dot(x) - distance; }
};

struct PoseErrors;

/// How the points count in a fit.
struct PlaneFitOptions {
  /// Weights 1 / (sigma^2 + unexplained^2), along the normal, where the cloud has sigma; else every
  /// point counts the same, as the least-squares reference plane of ISO 12781 asks.
  bool weigh_by_sigma = true;

  /// How unsure the poses are of the scans that the cloud is made up of; null = exact. Not owned.
  const PoseErrors* poses = nullptr;
};

/// A least-squares plane, how well the points lie on it, and how surely they decide it.
struct PlaneFit {
  Plane plane;                                         ///< normal turned so that distance >= 0
  Eigen::Vector3d centroid = Eigen::Vector3d::Zero();  ///< mean of the points, weighted, in it [m]
  Eigen::Vector3d axis_u = Eigen::Vector3d::UnitX();   ///< in the plane, where the points reach far
  Eigen::Vector3d axis_v = Eigen::Vector3d::UnitY();   ///< normal x axis_u
  std::size_t points = 0;                              ///< [1]
  double rms = 0;             ///< standard deviation of the distances, n - 3 degrees of freedom [m]
  double mean_absolute = 0;   ///< mean |distance| (source C's "mean distance") [m]
  double peak_to_valley = 0;  ///< least-squares flatness: largest minus smallest distance [m]
  double extent = 0;          ///< longer side of the points' bounding box in the plane [m]
  double width = 0;           ///< shorter side [m]
  double mean_range = 0;      ///< mean distance D from the sensor [m]
  double system_error = 0;    ///< 4 sigma / D (source C) [1]

  /// Covariance of (a, b, h) [rad^2, rad m, m^2]: the true plane has the normal n + a axis_u +
  /// b axis_v and lies h along n from the centroid. From the points' sigma along their rays and
  /// what it leaves unexplained, taken as independent; from rms where there is no sigma.
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();

  /// How (a, b, h) answer a range error that all points share [rad/m, rad/m, 1]: what independent
  /// errors leave out (a wrong calibration moves a whole plane).
  Eigen::Vector3d range_response = Eigen::Vector3d::Zero();

  /// How (a, b, h) answer one standard deviation of each of the six independent parts of the error
  /// of each scan's pose [rad, rad, m]: six columns a scan, none where poses are exact. A plane of
  /// several scans answers each by the points it has of it (to first order, GUM 5.1.2). Not part of
  /// the covariance, for planes of one scan share it.
  Eigen::Matrix<double, 3, Eigen::Dynamic> pose_response;

  double normal_sigma = 0;    ///< 1 standard deviation of the normal's direction, worst axis [rad]
  double distance_sigma = 0;  ///< 1 standard deviation of the distance at the centroid [m]
  double chi_squared = 0;     ///< sum of (distance / sigma)^2, 0 where there is no sigma [1]
  double unexplained = 0;     ///< of the distances by the sigmas, unexplained_variance.hpp [m]
  std::size_t degrees_of_freedom = 0;    ///< points - 3 [1]
  std::vector<Eigen::Vector3d> outline;  ///< convex hull of the points on the plane, anticlockwise
                                         ///< about the normal [m]
  double area = 0;                       ///< of the outline [m^2]

  /// 1 standard deviation of the plane's place along the normal at the foot of x [m].
  double sigma_at(const Eigen::Vector3d& x) const;

  /// The covariance of (a, b, h) for a plane given at the foot of `x` instead of the centroid; at
  /// the frame's origin, h is the plane's distance.
  Eigen::Matrix3d covariance_at(const Eigen::Vector3d& x) const;
};

/// Orthogonal least squares over all finite points of the cloud. Needs three points or more that do
/// not lie on a line; throws Error otherwise.
PlaneFit fit_plane(const PointCloud& cloud, const PlaneFitOptions& options = {});

/// The same over the points at `indices`.
PlaneFit fit_plane(const PointCloud& cloud,
                   const std::vector<std::size_t>& indices,
                   const PlaneFitOptions& options = {});

/// Angle between two planes [rad], in [0, pi/2].
double angle_between(const Plane& a, const Plane& b);

/// Mean distance from b's points (its centroid) to plane a [m], unsigned.
double distance_between(const PlaneFit& a, const PlaneFit& b);

struct PlaneExtractionOptions {
  /// Farthest point of a plane [m], above 0. None: default_inlier_distance(), or 3 sigma of the
  /// point along the normal where that is more.
  std::optional<double> inlier_distance;
  bool widen_by_sigma = false;   ///< let 3 sigma count where an inlier distance is given, too
  std::size_t min_points = 500;  ///< smallest plane [1], at least 3
  int max_planes = 12;           ///< [1], at least 1
  int iterations = 2000;         ///< RANSAC trials per plane at most [1]
  unsigned seed = 1;             ///< [1]

  /// Parts of a surface nearer than this are one plane [m]; 0 = the larger of 2 inlier distances
  /// and 8 times the points' own spacing there.
  double max_gap = 0;
  double max_normal_angle = 0.6;  ///< between a point's normal and the plane's, if it has one [rad]

  /// Planes whose points plainly bend by more than this from one side to the other are slices of a
  /// round surface and left out [rad], above 0.
  double max_bend = 0.12;
  int num_threads = 0;  ///< 0 = all cores [1]

  void check() const;
};

struct ExtractedPlane {
  PlaneFit fit;
  std::vector<std::size_t> indices;  ///< of the cloud's points on this plane
};

/// Four times the noise of the surfaces, measured on small neighbourhoods of some points [m]: holds
/// a noisy plane together and does not reach far round a bend. 1e-6 m at least.
double default_inlier_distance(const PointCloud& cloud);

/// Planes by RANSAC (Fischler and Bolles 1981), largest first, each refined by least squares over
/// the inliers of its largest connected piece. The same seed gives the same planes, whatever the
/// number of threads. Normals, where the cloud has them, keep points of other surfaces out.
std::vector<ExtractedPlane> extract_planes(const PointCloud& cloud,
                                           const PlaneExtractionOptions& options = {});

/// Planes by growing regions over the scan grid from the flattest places on (Rabbani et al. 2006),
/// each refined and judged as those of extract_planes(). No randomness; the cloud needs normals.
std::vector<ExtractedPlane> grow_planes(const PointCloud& cloud,
                                        const ScanGrid& grid,
                                        const PlaneExtractionOptions& options = {});

}  // namespace facula
