// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/range/triangulate_by_range.hpp>

#include <cmath>

namespace facula {

std::optional<TriangulatedPoint> triangulate_by_range(const Rig& rig,
                                                      const Eigen::Vector2d& pixel,
                                                      double pixel_sigma) {
  require(
      rig.range.has_value(), "rig '", rig.name, "' has neither a laser plane nor a range model");
  const bool per_row = rig.stripe_direction == StripeDirection::kPerRow;
  const double across = per_row ? pixel.x() : pixel.y();
  const double along = per_row ? pixel.y() : pixel.x();
  CompensationTable::Correction correction;
  if (rig.compensation) {
    correction = rig.compensation->correction(static_cast<int>(std::lround(along)), across);
  }
  const double px = across + correction.shift;
  const std::optional<double> depth = rig.range->depth(px);
  const std::optional<Eigen::Vector2d> normalized = rig.camera.undistort(pixel);
  if (!depth || !normalized) return std::nullopt;
  const Eigen::Vector3d ray(normalized->x(), normalized->y(), 1);
  // How the point moves along its ray: it gets deeper, and the ray itself turns.
  const double deeper = rig.range->depth_per_px(px) * (1 + correction.slope) * ray.norm();
  const double turns = per_row ? *depth * ray.x() / (rig.camera.fx * ray.norm())
                               : *depth * ray.y() / (rig.camera.fy * ray.norm());
  return TriangulatedPoint{*depth * ray, std::abs(deeper + turns) * pixel_sigma};
}

}  // namespace facula
