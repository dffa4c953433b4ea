// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

namespace facula {

/// A cloud whose coordinates are multiples of `unit`, a power of two, at most 2^52 of them long.
struct WidthCloud {
  std::string kind;
  std::vector<Eigen::Vector3d> points;
  double unit = 1;    // [m]
  bool flat = false;  // made to lie in one plane, so that the width is 0
};

/// Cloud `seed` of an endless row that goes through twelve kinds: even and uneven clouds, spheres,
/// boxes with parallel faces, prisms, integer lattices, plates of aspect 1e-4, plates whose
/// flatness is rounding alone, four points, clusters with duplicates, planes and lines, each far
/// from or near the origin and up to 2^60 times larger or smaller.
WidthCloud width_cloud(unsigned seed);

}  // namespace facula
