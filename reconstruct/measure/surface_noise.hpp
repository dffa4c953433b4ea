// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/point_cloud.hpp>

namespace facula {

/// How far points scatter about the surface they lie on [m]: median, over some thousand points
/// drawn from the cloud, of the standard deviation about the plane of their neighbours. 0 where
/// there are too few points to tell, or where they fill space.
double surface_noise(const PointCloud& cloud);

}  // namespace facula
