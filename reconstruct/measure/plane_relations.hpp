// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/reconstruct/measure/plane.hpp>

#include <Eigen/Core>

namespace facula {

/// A value and its standard uncertainty (GUM), in the same unit.
struct Measured {
  double value = 0;
  double sigma = 0;
};

struct RelationOptions {
  /// Standard uncertainty of a range error that all points of both planes share [m], 0 or more. A
  /// point's sigma tells nothing of it: a zero point that is off lengthens every range alike. It
  /// cancels in steps and counts twice between walls that face each other.
  double shared_range_sigma = 0;

  void check() const;
};

/// A plane, and how a quantity answers its (a, b, h) (PlaneFit::covariance).
struct PlaneAnswer {
  const PlaneFit& fit;
  Eigen::Vector3d to;
};

/// Variance of a quantity that answers two planes, to first order (GUM 5.1.2): of their points'
/// noise, which is independent, and of what they share: the error of all ranges and those of the
/// poses of their scans, which cancel where both planes are of one scan.
double joint_variance(const PlaneAnswer& a, const PlaneAnswer& b, const RelationOptions& options);

/// Angle between two planes [rad], in [0, pi/2], with its joint_variance(). Below three standard
/// deviations nobody knows which way the planes open, so sigma then holds both ways.
Measured measured_angle(const PlaneFit& a, const PlaneFit& b, const RelationOptions& options = {});

/// Angle of the corner or edge that two planes seen from the frame's origin make [rad], in [0, pi]:
/// what a bevel laid against both reads, above pi/2 where it is blunt. Needs normals that point
/// away from the origin, as fit_plane() turns them.
Measured measured_corner(const PlaneFit& a, const PlaneFit& b, const RelationOptions& options = {});

/// Distance of b's centroid from plane a [m], unsigned: the distance of parallel planes, a step's
/// height. Its sigma grows with the tilt of a where b lies beside a's points.
Measured measured_distance(const PlaneFit& a,
                           const PlaneFit& b,
                           const RelationOptions& options = {});

/// Angle between a plane's normal and a direction that is known exactly, such as gravity [rad], in
/// [0, pi/2]: 0 for a level plane, pi/2 for an upright one. `direction` of any length above 0.
Measured measured_angle_to(const PlaneFit& fit,
                           const Eigen::Vector3d& direction,
                           const RelationOptions& options = {});

}  // namespace facula
