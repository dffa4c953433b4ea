// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/simulate/light_path.hpp>
#include <facula/acquire/simulate/shape_geometry.hpp>

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

namespace facula {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

// The fan as a plane mirror with unit normal m shows it: points x become A x + t, directions A d.
LaserFan mirrored(const LaserFan& fan, const Matrix3d& a, const Vector3d& t) {
  LaserFan image = fan;
  image.origin = a * fan.origin + t;
  image.normal = a * fan.normal;
  image.axis = a * fan.axis;
  image.side = a * fan.side;
  return image;
}

// Whether the sheet, five half widths thick, can meet the face: its corners do not all lie on one
// side. A bowed sheet bends by less than the face's share of its bend.
bool meets(const LaserFan& fan, const MirrorFace& face, const RigidTransform& camera_from_world) {
  double low = 0;
  double high = 0;
  bool first = true;
  for (const double u : {-1.0, 0.0, 1.0}) {
    for (const double v : {-1.0, 0.0, 1.0}) {
      const Vector3d x = camera_from_world * (face.centre + u * face.first + v * face.second);
      const double r = (x - fan.origin).norm();
      const double reach = 5 * fan.half_width(r) + std::abs(fan.bend) * face.first.norm() +
                           std::abs(fan.bend) * face.second.norm();
      const double off = fan.sheet_distance(x);
      low = first ? off - reach : std::min(low, off - reach);
      high = first ? off + reach : std::max(high, off + reach);
      first = false;
    }
  }
  return low <= 0 && high >= 0;
}

}  // namespace

std::optional<Vector3d> MirrorFace::crossing(const Vector3d& from, const Vector3d& to) const {
  const double before = normal.dot(from - centre);
  const double after = normal.dot(to - centre);
  if (!(before * after < 0)) return std::nullopt;
  const Vector3d x = from + before / (before - after) * (to - from);
  const bool within = std::abs(first.dot(x - centre)) <= first.squaredNorm() &&
                      std::abs(second.dot(x - centre)) <= second.squaredNorm();
  return within ? std::optional<Vector3d>(x) : std::nullopt;
}

std::vector<MirrorFace> mirror_faces(const Scene& scene) {
  std::vector<MirrorFace> faces;
  for (const SceneObject& object : scene.objects()) {
    if (object.mirror == 0) continue;
    const Vector3d half = half_extent(object.shape);
    for (int side = 0; side < 6; ++side) {
      const int k = side % 3;
      const auto edge = [&](int i) {
        return Vector3d(object.world_from_object.rotation * (half[i] * Vector3d::Unit(i)));
      };
      const Vector3d outwards = (side < 3 ? 1 : -1) * edge(k);
      faces.push_back({object.world_from_object.translation + outwards,
                       outwards.normalized(),
                       edge((k + 1) % 3),
                       edge((k + 2) % 3),
                       object.mirror});
    }
  }
  return faces;
}

bool LightPath::open(const Scene& scene, const Vector3d& x_in_world) const {
  if (!mirror) return !scene.occluded(x_in_world, start_in_world);
  if (!(mirror->normal.dot(x_in_world - mirror->centre) > 0)) return false;
  const auto turn = mirror->crossing(x_in_world, start_in_world);
  return turn && !scene.occluded(x_in_world, *turn) &&
         !scene.occluded(*turn, mirror->image_of(start_in_world));
}

std::vector<LightPath> light_paths(const std::vector<LaserFan>& fans,
                                   const std::vector<MirrorFace>& mirrors,
                                   const RigidTransform& world_from_camera) {
  std::vector<LightPath> paths;
  paths.reserve(fans.size() * (1 + mirrors.size()));
  for (const LaserFan& fan : fans) {
    paths.push_back({fan, world_from_camera * fan.origin, std::nullopt});
  }
  const RigidTransform camera_from_world = world_from_camera.inverse();
  for (const LaserFan& fan : fans) {
    const Vector3d laser_in_world = world_from_camera * fan.origin;
    for (const MirrorFace& face : mirrors) {
      const bool before = face.normal.dot(laser_in_world - face.centre) > 0;
      if (!before || !meets(fan, face, camera_from_world)) continue;
      const Vector3d m = camera_from_world.rotation * face.normal;
      const Matrix3d a = Matrix3d::Identity() - 2 * m * m.transpose();
      const Vector3d t = 2 * m.dot(camera_from_world * face.centre) * m;
      paths.push_back({mirrored(fan, a, t), face.image_of(laser_in_world), face});
    }
  }
  return paths;
}

}  // namespace facula
