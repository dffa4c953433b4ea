// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/rigid_transform.hpp>
#include <facula/acquire/core/triangle_mesh.hpp>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <Eigen/Core>

namespace facula {

struct BoxShape {
  Eigen::Vector3d size = Eigen::Vector3d::Ones();  ///< edge lengths, centred on the origin [m]
};
struct RoomShape {
  Eigen::Vector3d size = Eigen::Vector3d::Ones();  ///< a box seen from inside, likewise [m]
};
struct SphereShape {
  double radius = 1;  ///< [m]
};
struct CylinderShape {
  double radius = 1;  ///< about z [m]
  double height = 1;  ///< along z, centred on the origin, with both lids [m]
};
struct MeshShape {
  TriangleMesh mesh;  ///< [m]
};
using Shape = std::variant<BoxShape, RoomShape, SphereShape, CylinderShape, MeshShape>;

/// A thing in the world.
struct SceneObject {
  std::string name;
  Shape shape;
  RigidTransform world_from_object;
  double albedo = 0.7;  ///< share of light that is scattered back, Lambertian [0..1]
  /// Red, green and blue of the object, as shares of its albedo and of its glow [0..1].
  Eigen::Vector3d colour = Eigen::Vector3d::Ones();
  double mirror = 0;  ///< share that is reflected as by a mirror, boxes only; with albedo at most 1
  double glow = 0;    ///< signal that the object sends by itself, alike to all sides [DN]
};

/// Throws Error naming the object and what about it cannot be.
void check_object(const SceneObject& object);

/// Where a ray meets the scene.
struct SceneHit {
  double distance = 0;     ///< along the unit direction [m]
  Eigen::Vector3d point;   ///< world frame [m]
  Eigen::Vector3d normal;  ///< unit, towards the ray's origin [1]
  std::size_t object = 0;  ///< index of the object [1]
};

/// Closed-form shapes and meshes, with ray and distance queries. Queries are const and may run from
/// several threads. Shapes are intersected in double precision; meshes in Embree's float.
class Scene {
 public:
  explicit Scene(std::vector<SceneObject> objects);
  ~Scene();
  Scene(Scene&&) noexcept;
  Scene& operator=(Scene&&) noexcept;

  const std::vector<SceneObject>& objects() const;

  /// First surface along a unit direction, world frame, at a distance of 1e-6 m or more.
  std::optional<SceneHit> first_hit(const Eigen::Vector3d& origin,
                                    const Eigen::Vector3d& direction) const;

  /// Whether a surface lies between two points (1e-6 m off both ends).
  bool occluded(const Eigen::Vector3d& from, const Eigen::Vector3d& to) const;

  /// Distance from a point to the nearest surface [m], unsigned. Exact for every shape.
  double distance(const Eigen::Vector3d& x_in_world) const;

  /// Whether a point lies inside matter (in a box, outside a room, ...); meshes must be closed.
  bool inside(const Eigen::Vector3d& x_in_world) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Reads scene.toml: [[object]] tables with name, shape = "box" | "room" | "sphere" | "cylinder" |
/// "mesh", size_mm / radius_mm / height_mm / file + unit_mm, position_mm, rotation_deg (about x, y,
/// z, applied in that order), albedo, colour (red, green, blue), mirror, glow_dn. Throws Error as
/// read_rig() does.
Scene read_scene(const std::filesystem::path& path);

}  // namespace facula
