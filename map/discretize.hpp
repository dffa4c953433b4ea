// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/point_cloud.hpp>

namespace facula {

/// One point per cell and sensor origin, at the cell's middle, in the cells' order: what OctoMap's
/// `discretize` does to the points of one origin. Points that are not finite or outside the 65536
/// cells of an axis (OctoMap puts these anywhere) become NaN, so that whoever walks the rays counts
/// them.
PointCloud one_ray_per_cell(const PointCloud& cloud, double resolution);

}  // namespace facula
