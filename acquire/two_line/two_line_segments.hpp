// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/two_line/two_line_frame.hpp>

#include <vector>

namespace facula {

// The two ways to the lines of a frame; both fill upper_px, lower_px and separation_sigma_px, or
// failure, of readings whose centre_px is set.

/// The ideal picture's pixel of a pixel without distortion, and of a point on the plane z = 1.
Eigen::Vector2d ideal_pixel(const Eigen::Vector2d& normalized, const Rig& rig);

/// Sub-pixel stripe positions, undistorted one by one, and a weighted straight line through those
/// of a segment, evaluated in its middle.
void find_by_stripes(ImageView8 frame,
                     ImageView8 background,
                     const Rig& rig,
                     const TwoLineOptions& options,
                     std::vector<TwoLineReading>& readings);

/// Source E: the whole picture undistorted, a segment cut out, grey, threshold, Canny edges,
/// probabilistic Hough transform; segments evaluated in the middle column, those closer than
/// merge_distance grouped and averaged by length. separation_sigma_px is the scatter of the grouped
/// segments; as both edges of a line are among them, it is an upper bound.
void find_by_hough(ImageView8 frame,
                   ImageView8 background,
                   const Rig& rig,
                   const TwoLineOptions& options,
                   std::vector<TwoLineReading>& readings);

}  // namespace facula
