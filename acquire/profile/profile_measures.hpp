// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

namespace facula {

/// The bench of source D by its parts: the laser shines square to the baseline; the camera stands
/// `baseline` beside the beam and its axis, `angle` to the baseline, meets the beam on the
/// reference plane.
struct ProfileBench {
  double baseline = 0;        ///< b [m]
  double lens_to_sensor = 0;  ///< B [m]
  double angle = 0;           ///< alpha [rad], inside 0 to 90 degrees

  /// h = b s sec^2(alpha) / (B + s tan(alpha)): height over the reference plane of a spot seen
  /// `shift` beside the sensor's middle [m]. The formula is re-derived, the print is damaged.
  double height(double shift) const;

  /// Its inverse [m].
  double shift(double height) const;

  void check() const;
};

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
/// are left out. `profile` holds (across, height) [m] per column, NaN where nothing was seen.
/// Throws Error when a span leaves the profile or holds fewer than 5 points.
StepMeasure measure_step(const std::vector<Eigen::Vector2d>& profile,
                         const ProfileSpan& base,
                         const ProfileSpan& top);

}  // namespace facula
