// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/simulate/shape_geometry.hpp>
#include <facula/acquire/simulate/surface_rows.hpp>

#include <cmath>

#include <Eigen/Geometry>

namespace facula {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kReach = 5.0;  // half widths from the sheet beyond which its light is nothing [1]

// Whether the pixels between two others may be taken from the plane that both lie on: not near the
// sheet, where every pixel has a ray of its own.
bool same_plane_off_sheet(const Surface& a, const Surface& b) {
  if (a.object < 0 || b.object < 0) return a.object == b.object;
  const bool left = a.high < 0 && b.high < 0;
  const bool right = a.low > 0 && b.low > 0;
  return (left || right) && same_plane(a, b);
}

}  // namespace

bool same_plane(const Surface& a, const Surface& b) {
  return a.object == b.object && (a.normal - b.normal).squaredNorm() < 1e-20 &&
         std::abs(a.normal.dot(a.x - b.x)) < 1e-9;
}

bool same_bend(const Surface& a, const Surface& b) {
  return a.object == b.object && a.normal.dot(b.normal) > 0.9;
}

SurfaceRows::SurfaceRows(const Scene& scene,
                         const RayTable& rays,
                         const RigidTransform& world_from_camera,
                         const LaserFan* fan)
    : scene_(scene),
      rays_(rays),
      fan_(fan),
      world_from_camera_(world_from_camera.rotation.toRotationMatrix()),
      camera_in_world_(world_from_camera.translation) {
  for (auto& row : ring_) row.resize(static_cast<std::size_t>(rays.width()));
  for (const SceneObject& object : scene.objects()) {
    object_from_camera_.push_back(object.world_from_object.inverse() * world_from_camera);
  }
}

void SurfaceRows::advance_to(int r) {
  while (traced_ <= std::min(r + 1, rays_.height() - 1)) trace_next_rows();
}

Surface SurfaceRows::surface_at(const Vector3d& x, const Vector3d& normal, int object) const {
  Surface result;
  result.object = object;
  result.x = x;
  result.normal = normal;
  if (fan_ == nullptr) {  // far on one side of every sheet
    result.low = result.high = std::numeric_limits<double>::infinity();
    return result;
  }
  const double reach = kReach * fan_->half_width((x - fan_->origin).norm());
  const double sheet = fan_->sheet_distance(x);
  result.low = sheet - reach;
  result.high = sheet + reach;
  return result;
}

Surface SurfaceRows::cast(const Vector2d& ray) const {
  const Vector3d direction = Vector3d(ray.x(), ray.y(), 1).normalized();
  if (!direction.allFinite()) return {};
  const auto hit = scene_.first_hit(camera_in_world_, world_from_camera_ * direction);
  if (!hit) return {};
  return surface_at(hit->distance * direction,
                    world_from_camera_.transpose() * hit->normal,
                    static_cast<int>(hit->object));
}

Surface SurfaceRows::on_plane(const Surface& plane, const Vector2d& ray) const {
  if (plane.object < 0) return {};
  const Vector3d direction(ray.x(), ray.y(), 1);
  const double depth = plane.normal.dot(plane.x) / plane.normal.dot(direction);
  return surface_at(depth * direction, plane.normal, plane.object);
}

Surface SurfaceRows::cast_on(int object, const Vector2d& ray) const {
  const RigidTransform& object_from_camera = object_from_camera_[static_cast<std::size_t>(object)];
  const Vector3d direction = Vector3d(ray.x(), ray.y(), 1).normalized();
  const auto hit = intersect_shape(scene_.objects()[static_cast<std::size_t>(object)].shape,
                                   object_from_camera.translation,
                                   object_from_camera.rotation * direction,
                                   0.0);
  if (!hit) return {};
  const Vector3d normal = object_from_camera.rotation.conjugate() * hit->normal;
  return surface_at(
      hit->distance * direction, normal.dot(direction) > 0 ? Vector3d(-normal) : normal, object);
}

// An even row by itself; an odd row together with the one below it, which it is drawn from.
void SurfaceRows::trace_next_rows() {
  const int r = traced_;
  const bool between = r % 2 == 1 && r + 1 < rays_.height();
  if (between) {
    trace_alone(r + 1);
    for (int c = 0; c < rays_.width(); ++c) {
      at(r, c) = trace_between(at(r - 1, c), at(r + 1, c), r, c);
    }
  } else {
    trace_alone(r);
  }
  traced_ += between ? 2 : 1;
}

void SurfaceRows::trace_alone(int r) {
  const int width = rays_.width();
  for (int c = 0; c < width; c += 2) at(r, c) = cast(rays_.centre(r, c));
  for (int c = 1; c < width; c += 2) {
    at(r, c) =
        c + 1 < width ? trace_between(at(r, c - 1), at(r, c + 1), r, c) : cast(rays_.centre(r, c));
  }
}

// A pixel between two others on one plane is taken to show the same plane, one ray saved. Its spot
// is left where a's is: off the sheet only the plane and the side of the sheet are asked for.
Surface SurfaceRows::trace_between(const Surface& a, const Surface& b, int r, int c) const {
  if (!same_plane_off_sheet(a, b)) return cast(rays_.centre(r, c));
  Surface between = a;
  between.light = SpotLight::kUnknown;
  return between;
}

}  // namespace facula
