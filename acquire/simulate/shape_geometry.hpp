// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/simulate/scene.hpp>

#include <optional>

#include <Eigen/Core>

namespace facula {

/// Where a ray meets a shape, in the shape's own frame.
struct ShapeHit {
  double distance = 0;     ///< along the unit direction [m]
  Eigen::Vector3d normal;  ///< unit, outwards [1]
};

/// Closed forms, double precision, for the convex shapes: box, room, sphere, cylinder (all centred
/// on the origin of their frame; a room is the same surface as a box). A mesh throws Error.

/// First crossing of the surface at a distance of `nearest` [m] or more.
std::optional<ShapeHit> intersect_shape(const Shape& shape,
                                        const Eigen::Vector3d& origin,
                                        const Eigen::Vector3d& direction,
                                        double nearest);

/// Distance from a point to the surface [m], negative within the convex body.
double signed_distance(const Shape& shape, const Eigen::Vector3d& x);

/// Half of the edge lengths of the box around the shape [m].
Eigen::Vector3d half_extent(const Shape& shape);

/// Throws Error when a size is not finite and above 0.
void check_shape(const Shape& shape);

}  // namespace facula
