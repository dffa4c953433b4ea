// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

namespace facula {

/// Side of a regular polygon that lies on one side and stands `height` high: for an even number of
/// sides the height is the distance across flats, for an odd one that from a side to the opposite
/// corner. Throws Error for fewer than 3 sides or a height not above 0.
double polygon_side(int sides, double height);

/// Side over height of polygon_side() [1].
double polygon_ratio(int sides);

/// Columns [first, last) of a profile.
struct ProfileSpan {
  std::size_t first = 0;
  std::size_t last = 0;
};

struct StepMeasure {
  double thickness = 0;     ///< of the top over the base's line, square to it [m]
  double sigma = 0;         ///< 1 standard deviation of it, from the scatter on both spans [m]
  double base_scatter = 0;  ///< about the base's line [m]
  double top_scatter = 0;   ///< about the top's mean distance [m]
  std::size_t base_points = 0;
  std::size_t top_points = 0;
};

/// Thickness of what lies on a base, as of a stack of disks: a line through the base's points, and
/// the mean distance of the top's points from it; points farther than 3 robust standard deviations
/// are left out. Points are (across, height) [m]. Throws Error for fewer than 5 points on either.
StepMeasure measure_step(const std::vector<Eigen::Vector2d>& base,
                         const std::vector<Eigen::Vector2d>& top);

/// The same on columns of a profile, NaN where nothing was seen. Throws Error when a span leaves
/// the profile.
StepMeasure measure_step(const std::vector<Eigen::Vector2d>& profile,
                         const ProfileSpan& base,
                         const ProfileSpan& top);

}  // namespace facula
