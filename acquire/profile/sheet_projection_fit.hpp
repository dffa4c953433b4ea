// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/profile/sheet_projection.hpp>

#include <string>
#include <vector>

#include <Eigen/Core>

namespace facula {

/// A known point of the sheet and where it was seen.
struct SheetPoint {
  Eigen::Vector2d in_sheet;  ///< across and height [m]
  Eigen::Vector2d pixel;     ///< undistorted where the lens distorts [px]
};

struct SheetProjectionFit {
  SheetProjection projection;
  std::vector<double> residual_px;  ///< image distance per point [px]
  std::vector<double> residual;     ///< distance in the sheet per point [m]
  double rms_px = 0;                ///< [px]
  double rms = 0;                   ///< [m]
  double held_out_rms_px = 0;       ///< each point from the fit without it [px]
  double held_out_rms = 0;          ///< [m]
  std::vector<std::string> warnings;
};

/// The P that makes the distances between measured and projected points in the picture smallest
/// (source D, min sum d(x_i, P X_i)): the direct linear solution with normalised coordinates
/// (Hartley 1997), then least squares. Throws Error when a value is not finite, fewer than 5 points
/// are given, or all but one lie on one line.
SheetProjectionFit fit_sheet_projection(const std::vector<SheetPoint>& points);

}  // namespace facula
