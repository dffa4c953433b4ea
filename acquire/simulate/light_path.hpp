// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/rigid_transform.hpp>
#include <facula/acquire/simulate/laser_fan.hpp>
#include <facula/acquire/simulate/scene.hpp>

#include <optional>
#include <vector>

#include <Eigen/Core>

namespace facula {

/// A face of a box that reflects as a mirror does. World frame.
struct MirrorFace {
  Eigen::Vector3d centre;  ///< [m]
  Eigen::Vector3d normal;  ///< unit, out of the box [1]
  Eigen::Vector3d first;   ///< from the centre to the middle of an edge [m]
  Eigen::Vector3d second;  ///< to the middle of the edge beside it [m]
  double share = 0;        ///< of the light that it reflects [0..1]

  Eigen::Vector3d image_of(const Eigen::Vector3d& x) const {
    return x - 2 * normal.dot(x - centre) * normal;
  }

  /// Where the straight way between two points on different sides passes through the face.
  std::optional<Eigen::Vector3d> crossing(const Eigen::Vector3d& from,
                                          const Eigen::Vector3d& to) const;
};

/// All faces of the scene's mirrors.
std::vector<MirrorFace> mirror_faces(const Scene& scene);

/// A way that a fan's light takes to the scene: straight, or by way of one mirror. Light that comes
/// by a mirror comes as if from the mirror's image of the laser.
struct LightPath {
  LaserFan fan;                    ///< or its mirror image; camera frame
  Eigen::Vector3d start_in_world;  ///< of that fan [m]
  std::optional<MirrorFace> mirror;

  double share() const { return mirror ? mirror->share : 1.0; }

  /// Whether light gets to a point of the scene along this path.
  bool open(const Scene& scene, const Eigen::Vector3d& x_in_world) const;
};

/// The straight paths of the fans, then those by way of the mirrors that the fans' light meets.
std::vector<LightPath> light_paths(const std::vector<LaserFan>& fans,
                                   const std::vector<MirrorFace>& mirrors,
                                   const RigidTransform& world_from_camera);

}  // namespace facula
