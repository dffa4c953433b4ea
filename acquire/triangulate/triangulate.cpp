// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/range/triangulate_by_range.hpp>
#include <facula/acquire/triangulate/triangulate.hpp>

#include <cmath>

namespace facula {
namespace {

std::optional<Eigen::Vector3d> point_on_sheet(const Rig& rig,
                                              std::size_t laser,
                                              const Eigen::Vector2d& pixel) {
  const std::optional<Eigen::Vector2d> normalized = rig.camera.undistort(pixel);
  if (!normalized) return std::nullopt;
  return rig.lasers[laser].intersect({normalized->x(), normalized->y(), 1.0});
}

}  // namespace

std::optional<TriangulatedPoint> triangulate(const Rig& rig,
                                             std::size_t laser,
                                             const Eigen::Vector2d& pixel,
                                             double pixel_sigma) {
  require(laser < rig.light_count(),
          "expected a laser below ",
          rig.light_count(),
          ", the number in the rig, got ",
          laser);
  if (rig.lasers.empty()) return triangulate_by_range(rig, pixel, pixel_sigma);
  const std::optional<Eigen::Vector3d> point = point_on_sheet(rig, laser, pixel);
  if (!point) return std::nullopt;
  // The derivative across the line by a central difference of one pixel; one-sided at infinity.
  const Eigen::Vector2d half = rig.stripe_direction == StripeDirection::kPerRow
                                   ? Eigen::Vector2d(0.5, 0)
                                   : Eigen::Vector2d(0, 0.5);
  const auto before = point_on_sheet(rig, laser, pixel - half);
  const auto after = point_on_sheet(rig, laser, pixel + half);
  if (!before && !after) return std::nullopt;
  const double span = before && after ? 1.0 : 0.5;
  const Eigen::Vector3d moved = after.value_or(*point) - before.value_or(*point);
  return TriangulatedPoint{*point, std::abs(moved.dot(point->normalized())) / span * pixel_sigma};
}

}  // namespace facula
