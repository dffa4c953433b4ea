// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/profile/sheet_projection.hpp>

#include <cmath>

#include <Eigen/Geometry>
#include <Eigen/LU>

namespace facula {

Eigen::Vector2d SheetProjection::project(const Eigen::Vector2d& in_sheet) const {
  return (image_from_sheet * in_sheet.homogeneous()).hnormalized();
}

std::optional<Eigen::Vector2d> SheetProjection::in_sheet(const Eigen::Vector2d& pixel) const {
  const Eigen::Vector3d x = image_from_sheet.inverse() * pixel.homogeneous();
  // The scale is set so that the third row is positive at the points it was fitted to.
  if (!(x.z() > 0)) return std::nullopt;
  const Eigen::Vector2d point = x.hnormalized();
  if (!point.allFinite()) return std::nullopt;
  return point;
}

void SheetProjection::check() const {
  require(image_from_sheet.allFinite(), "expected a finite projection matrix of the sheet");
  const Eigen::Matrix3d scaled =
      image_from_sheet * image_from_sheet.colwise().norm().cwiseInverse().asDiagonal();
  require(std::abs(scaled.determinant()) > 1e-12,
          "the projection matrix of the sheet is singular: the camera lies in the sheet of light");
}

}  // namespace facula
