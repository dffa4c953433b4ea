// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/reconstruct/measure/plane_relations.hpp>

#include <vector>

#include <Eigen/Core>

namespace facula {

/// How wide a tolerance zone after ISO 1101 must be to hold a flat surface.
struct ToleranceZone {
  /// Of the fitted plane within its outline [m]: the orientation alone. What repeats.
  Measured plane;
  /// Of the points themselves [m], as the standard asks: orientation, form and noise together. n
  /// points of noise sigma add up to 2 sqrt(2 ln n) sigma, so it is an upper bound.
  double points = 0;
};

/// Parallelism to a datum plane (ISO 1101): the distance of two planes parallel to the
/// datum that hold the surface. The datum is the least-squares plane. `points` are the
/// surface's own; none gives a zone of 0 for them.
ToleranceZone parallelism(const PlaneFit& surface,
                          const PlaneFit& datum,
                          const std::vector<Eigen::Vector3d>& points,
                          const RelationOptions& options = {});

/// Perpendicularity to a datum plane (ISO 1101): the distance of two planes at right
/// angles to the datum that hold the surface; they may turn about the datum's normal.
ToleranceZone perpendicularity(const PlaneFit& surface,
                               const PlaneFit& datum,
                               const std::vector<Eigen::Vector3d>& points,
                               const RelationOptions& options = {});

}  // namespace facula
