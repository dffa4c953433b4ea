// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace facula {

/// The two parallel planes nearest each other that have all points between them.
struct Width {
  double width = 0;                                      ///< their distance [m]
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();  ///< their normal, unit length [1]
  double low = 0;                                        ///< direction . x on the lower plane [m]
  double high = 0;                                       ///< and on the upper one [m]
  std::vector<std::uint32_t> low_points;   ///< points on the lower plane that decide it
  std::vector<std::uint32_t> high_points;  ///< together three and one, or two and two; fewer where
                                           ///< all points lie in one plane
  std::size_t hull_points = 0;             ///< corners of the convex hull [1]
};

struct WidthOptions {
  int num_threads = 0;  ///< 0 = all cores [1]
};

/// The width of a set of points, exact to the last digits of a double however flat it is: the
/// convex hull, then every pair of supporting planes that touch it in a face and a corner or in two
/// edges (Houle and Toussaint 1988). Points must be finite. Points in one plane give 0. Throws
/// Error for no points or points that are not finite.
Width width_of(const std::vector<Eigen::Vector3d>& points, const WidthOptions& options = {});

}  // namespace facula
