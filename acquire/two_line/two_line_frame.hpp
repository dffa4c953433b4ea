// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/image_view.hpp>
#include <facula/acquire/rig/rig.hpp>
#include <facula/acquire/stripe/stripe_detector.hpp>

#include <optional>
#include <string>
#include <vector>

namespace facula {

/// How the lines are found in a segment of the picture.
enum class TwoLineMethod {
  kStripes,  ///< sub-pixel position in every column, then a line through them
  kHough     ///< source E: threshold, edges, Hough line segments, grouped and averaged
};

struct TwoLineOptions {
  TwoLineMethod method = TwoLineMethod::kStripes;
  int segments = 7;           ///< side by side about the middle of the picture [1]
  int segment_width = 50;     ///< [px]
  double threshold = 0;       ///< of the grey picture, kHough; 0 = half way up
                              ///< from the background to the brightest of the segment [DN]
  double merge_distance = 8;  ///< segments closer than this are one line, kHough [px]
  StripeOptions stripe;       ///< kStripes; its direction and region are set here
  void check() const;
};

/// What one segment of the picture shows.
struct TwoLineReading {
  double centre_px = 0;  ///< middle column of the ideal picture, see read_two_lines() [px]
  double angle = 0;      ///< of that column from the camera's axis [rad]
  double upper_px = 0;   ///< rows of the lines in the middle column of that picture [px]
  double lower_px = 0;   ///< [px]
  double separation_sigma_px = 0;  ///< 1 standard deviation of lower - upper [px]
  std::optional<double> depth;     ///< [m]
  double sigma = 0;                ///< of the depth, (11) [m]
  std::string failure;             ///< why there is no depth; empty where there is one
};

/// Distance in every segment of a frame of a two-line head: the two lines' rows in the middle
/// column of the segment give the depth by the head. Rows and columns are those of the ideal
/// picture: without distortion, and as a camera in the medium itself would take it, its focal
/// length longer by the index (a plane's line is straight only there). The upper line is looked for
/// above the camera's principal point, the lower one below (the camera stands between the sheets).
/// `background` may be empty. Throws Error when the rig has no two-line head or the segments do not
/// fit the picture; a segment without two lines says so in its failure.
std::vector<TwoLineReading> read_two_lines(ImageView8 frame,
                                           ImageView8 background,
                                           const Rig& rig,
                                           const TwoLineOptions& options = {});

/// Separation of the lines of a reading on the plane z = 1 [1].
double separation_of(const TwoLineReading& reading, const Rig& rig);

}  // namespace facula
