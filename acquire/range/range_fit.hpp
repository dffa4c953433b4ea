// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/range/range_model.hpp>

#include <string>
#include <vector>

#include <Eigen/Core>

namespace facula {

/// One measurement: where the stripe of a thing at a known distance was seen.
struct RangePoint {
  double px = 0;        ///< [px]
  double distance = 0;  ///< from where it was measured, see RangeTerms::kOrigin [m]
};

/// What is estimated besides slope and vanishing position.
enum class RangeTerms {
  kPlain,  ///< nothing: d = A / (x0 - px)
  kBend,   ///< third-order distortion of the position
  kOrigin  ///< where the distances count from: d = A / (x0 - px) + origin
};

/// What is made small. Noise sits in the picture, so the first is the likelier answer where the
/// distances are exact; the second is what the sources do and asks more of the farthest points.
enum class RangeResidual { kPixels, kDistances };

struct RangeFitOptions {
  RangeTerms terms = RangeTerms::kPlain;
  RangeResidual minimise = RangeResidual::kPixels;
  double centre = 320;  ///< about which the bend counts: the middle of the picture [px]
  void check() const;
};

struct RangeFit {
  RangeTerms terms = RangeTerms::kPlain;
  RangeResidual minimised = RangeResidual::kPixels;
  RangeModel model;
  double origin = 0;                ///< distance = depth + origin; 0 unless kOrigin [m]
  Eigen::VectorXd sigma;            ///< of slope, vanishing and the third parameter if there is one
  std::vector<double> residual_px;  ///< measured - modelled position, per point [px]
  std::vector<double> residual;     ///< modelled - measured distance, per point [m]
  std::vector<double> held_out_px;  ///< the same from the fit without the point [px]
  std::vector<double> held_out;     ///< [m]
  double rms_px = 0;                ///< of residual_px [px]
  double rms = 0;                   ///< of residual [m]
  double held_out_rms_px = 0;       ///< leave-one-out error [px]
  double held_out_rms = 0;          ///< leave-one-out error [m]
  std::vector<std::string> warnings;  ///< what these points cannot decide, and what to add
};

/// Least squares over the points. Throws Error, saying which, when they cannot determine the model:
/// a value that is not finite, fewer than one more than there are parameters, equal distances, a
/// position that lies beyond the vanishing one, distances that do not follow a hyperbola at all.
RangeFit fit_range(const std::vector<RangePoint>& points, const RangeFitOptions& options = {});

/// Every kind of terms that the points allow, the smallest leave-one-out error (of what is
/// minimised) first. Throws Error when not even the plain hyperbola can be fitted.
std::vector<RangeFit> compare_range_models(const std::vector<RangePoint>& points,
                                           const RangeFitOptions& options = {});

/// "plain", "bend" or "origin".
std::string to_string(RangeTerms terms);

}  // namespace facula
