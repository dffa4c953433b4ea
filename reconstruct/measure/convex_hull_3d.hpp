// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace facula {

/// The convex hull of points in space: triangles, counter-clockwise seen from outside. Faces with
/// more corners are several triangles in one plane.
struct ConvexHull {
  int dimension = 0;  ///< of the points: 0 one spot, 1 a line, 2 a plane, 3 space [1]
  std::vector<std::array<std::uint32_t, 3>> faces;       ///< indices of points; none below 3
  std::vector<std::array<std::uint32_t, 3>> neighbours;  ///< face across the edge from corner i to
                                                         ///< corner i + 1
  std::array<std::uint32_t, 3> span{};  ///< points that span the line or plane where there are no
                                        ///< faces
};

/// The hull by quickhull (Barber, Dobkin and Huhdanpaa 1996) with exact decisions, so that points
/// in one plane, on one line, in one spot or on a lattice do not lead it astray. Points must be
/// finite; fewer than 2^32. Throws Error for no points.
ConvexHull convex_hull_3d(const std::vector<Eigen::Vector3d>& points);

}  // namespace facula
