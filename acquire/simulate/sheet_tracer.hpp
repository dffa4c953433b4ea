// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/rigid_transform.hpp>
#include <facula/acquire/rig/rig.hpp>
#include <facula/acquire/simulate/laser_fan.hpp>
#include <facula/acquire/simulate/scene.hpp>

#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Core>

namespace facula {

/// Where a ray of the fan's middle first meets the scene, camera frame.
struct FanHit {
  double angle = 0;   ///< of the ray in the sheet [rad]
  Eigen::Vector3d x;  ///< [m]
  Eigen::Vector3d normal;
  std::size_t object = 0;
  Eigen::Vector2d pixel;
  double row = 0;  ///< image coordinate along the stripe [px]
};

/// Follows the middle of the sheet over the scene, for one pose of the head. Works from the laser's
/// side with rays of its own; of the image it knows only the camera's projection. Light that comes
/// by way of a mirror is not followed. All arguments are referred to.
class SheetTracer {
 public:
  SheetTracer(const Scene& scene, const Rig& rig, const LaserFan& fan, LaserColour colour);

  void place(const RigidTransform& world_from_camera) { world_from_camera_ = world_from_camera; }

  std::size_t rows() const;

  /// Per image row the brightest point of the sheet's middle that the camera sees there.
  std::vector<std::optional<FanHit>> trace() const;

  /// Signal of the point in the middle of the sheet [DN].
  double brightness(const FanHit& hit) const;

 private:
  std::optional<FanHit> shoot(double angle) const;
  void keep_crossings(const FanHit& a,
                      const FanHit& b,
                      std::vector<std::optional<FanHit>>& brightest) const;
  std::optional<FanHit> refine(FanHit a, FanHit b, int row) const;
  bool seen(const FanHit& hit) const;

  const Scene& scene_;
  const Camera& camera_;
  const LaserFan& fan_;
  LaserColour colour_;
  bool per_row_ = true;
  RigidTransform world_from_camera_;
};

}  // namespace facula
