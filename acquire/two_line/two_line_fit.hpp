// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/two_line/two_line_head.hpp>

#include <string>
#include <vector>

namespace facula {

/// How far apart the two lines were seen on a surface at a known distance.
struct TwoLinePoint {
  double separation = 0;  ///< on the plane z = 1 (undistorted pixels over the focal length) [1]
  double distance = 0;    ///< [m]
};

struct TwoLineFitOptions {
  bool divergence = true;   ///< also tried: sheets that are not quite parallel
  double medium_index = 1;  ///< stored with the head; separations are those in the medium [1]
};

struct TwoLineFit {
  TwoLineHead head;
  double spacing_sigma = 0;          ///< [m]
  double divergence_sigma = 0;       ///< 0 where the sheets were taken as parallel [1]
  std::vector<double> residual;      ///< modelled - measured distance, per point [m]
  double rms_separation = 0;         ///< of the separations [1]
  double rms = 0;                    ///< of the distances [m]
  double held_out_rms = 0;           ///< leave-one-out error of the distances [m]
  double parallel_held_out_rms = 0;  ///< the same where the sheets are taken as parallel [m]
  std::vector<std::string> warnings;
};

/// Spacing, and the drift of the sheets where leaving one out says that it is worth it, from
/// separations at known distances by least squares over the separations. Throws Error when a value
/// is not finite, fewer than 2 points are given, or separations do not shrink with distance.
TwoLineFit fit_two_line(const std::vector<TwoLinePoint>& points,
                        const TwoLineFitOptions& options = {});

}  // namespace facula
