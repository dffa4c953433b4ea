// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/point_cloud.hpp>
#include <facula/reconstruct/measure/primitive_fit.hpp>
#include <facula/reconstruct/measure/sphere.hpp>

#include <cstddef>
#include <vector>

#include <Eigen/Core>

namespace facula {

struct Cylinder {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< on the axis [m]
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();  ///< unit length [1]
  double radius = 1;                                ///< [m]

  double signed_distance(const Eigen::Vector3d& x) const {
    const Eigen::Vector3d d = x - point;
    return (d - d.dot(axis) * axis).norm() - radius;
  }
};

struct CylinderFit {
  Cylinder cylinder;        ///< point: at the middle of the points' stretch of the axis
  double length = 0;        ///< of the stretch that the points cover [m]
  double covered = 0;       ///< of the circumference, seen along the axis [rad], up to 2 pi
  double radius_sigma = 0;  ///< 1 standard deviation [m]
  double axis_sigma = 0;    ///< of the axis's direction, worst way [rad]
  Eigen::Vector3d axis_u = Eigen::Vector3d::UnitX();  ///< square to the axis
  Eigen::Vector3d axis_v = Eigen::Vector3d::UnitY();  ///< axis x axis_u
  PrimitiveQuality quality;  ///< covariance of (place along u, v [m]; tilt towards u, v [rad];
                             ///< radius [m]) at the point
};

/// Geometric least squares from a first guess of axis and radius. Needs five points; throws Error
/// when they leave the cylinder undecided.
CylinderFit fit_cylinder(const PointCloud& cloud,
                         const std::vector<std::size_t>& indices,
                         const Cylinder& start,
                         const PrimitiveFitOptions& options = {});

struct FoundCylinder {
  CylinderFit fit;
  std::vector<std::size_t> indices;  ///< of the cloud's points on it
};

/// The cylinder with most points on it by RANSAC over two points and their normals a try, judged by
/// 5000 points drawn from the cloud, then least squares over its points. The cloud must have
/// normals. The same seed gives the same cylinder. Throws Error when none has min_points.
FoundCylinder find_cylinder(const PointCloud& cloud, const ShapeSearchOptions& options = {});

}  // namespace facula
