// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>

#include <Eigen/Core>

namespace facula {

/// Distance from a point to a triangle, its edges and corners included [m].
double distance_to_triangle(const std::array<Eigen::Vector3d, 3>& corners,
                            const Eigen::Vector3d& x);

}  // namespace facula
