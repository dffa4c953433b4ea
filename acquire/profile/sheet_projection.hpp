// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include <Eigen/Core>

namespace facula {

/// Model based calibration (source D, III.2): the projection matrix P restricted to the sheet of
/// light. A point (across, height) of the sheet is seen at the pixel P (across, height, 1); of the
/// 3 x 4 matrix only the columns along the sheet and the origin's remain.
struct SheetProjection {
  Eigen::Matrix3d image_from_sheet = Eigen::Matrix3d::Identity();  ///< [px, px, 1] from [m, m, 1]

  /// Pixel of a point of the sheet [m].
  Eigen::Vector2d project(const Eigen::Vector2d& in_sheet) const;

  /// Point of the sheet seen at a pixel [m]; none on the line where the sheet vanishes and beyond.
  std::optional<Eigen::Vector2d> in_sheet(const Eigen::Vector2d& pixel) const;

  /// Throws Error when the matrix is not finite or is singular (the camera lies in the sheet).
  void check() const;
};

}  // namespace facula
