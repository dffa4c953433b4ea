// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/rig/rig.hpp>
#include <facula/acquire/triangulate/triangulate.hpp>

#include <optional>

#include <Eigen/Core>

namespace facula {

/// The point of a stripe by the rig's range model instead of a sheet: the compensation table, where
/// the rig has one, brings the position to that of the middle line, the model turns it into depth,
/// and the point lies at that depth on the pixel's own ray. `pixel_sigma` [px] as in triangulate().
/// None where the position lies on or beyond that of infinity. Throws Error when the rig has no
/// range model.
std::optional<TriangulatedPoint> triangulate_by_range(const Rig& rig,
                                                      const Eigen::Vector2d& pixel,
                                                      double pixel_sigma);

}  // namespace facula
