// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/simulate/shape_geometry.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace facula {
namespace {

using Eigen::Vector3d;

// The part of a line that lies within a convex body, with the outward normals where it enters and
// leaves.
struct Chord {
  double enter = -std::numeric_limits<double>::infinity();
  double leave = std::numeric_limits<double>::infinity();
  Vector3d enter_normal = Vector3d::Zero();
  Vector3d leave_normal = Vector3d::Zero();

  bool empty() const { return !(enter < leave); }
};

// Cuts the chord by the slab |x[axis]| <= half.
void cut_by_slab(
    Chord& chord, const Vector3d& origin, const Vector3d& direction, int axis, double half) {
  const double o = origin[axis];
  const double d = direction[axis];
  if (d == 0) {
    if (std::abs(o) > half) chord.leave = chord.enter;
    return;
  }
  const double side = d > 0 ? 1 : -1;
  const double enter = (-side * half - o) / d;
  const double leave = (side * half - o) / d;
  if (enter > chord.enter) {
    chord.enter = enter;
    chord.enter_normal = -side * Vector3d::Unit(axis);
  }
  if (leave < chord.leave) {
    chord.leave = leave;
    chord.leave_normal = side * Vector3d::Unit(axis);
  }
}

Chord box_chord(const Vector3d& half, const Vector3d& origin, const Vector3d& direction) {
  Chord chord;
  for (int axis = 0; axis < 3; ++axis) cut_by_slab(chord, origin, direction, axis, half[axis]);
  return chord;
}

// Half the chord is sqrt(r^2 - p^2) with p the line's distance from the centre: unlike
// b^2 - 4ac this loses nothing when the origin is far away.
Chord sphere_chord(double radius, const Vector3d& origin, const Vector3d& direction) {
  Chord chord;
  const double middle = -origin.dot(direction);
  const double off_centre2 = (origin + middle * direction).squaredNorm();
  if (off_centre2 >= radius * radius) {
    chord.leave = chord.enter;
    return chord;
  }
  const double half = std::sqrt(radius * radius - off_centre2);
  chord.enter = middle - half;
  chord.leave = middle + half;
  chord.enter_normal = (origin + chord.enter * direction) / radius;
  chord.leave_normal = (origin + chord.leave * direction) / radius;
  return chord;
}

Chord cylinder_chord(const CylinderShape& shape,
                     const Vector3d& origin,
                     const Vector3d& direction) {
  Chord chord;
  const double across2 = direction.head<2>().squaredNorm();
  if (across2 > 0) {
    const double middle = -origin.head<2>().dot(direction.head<2>()) / across2;
    const Vector3d nearest = origin + middle * direction;
    const double rest2 = shape.radius * shape.radius - nearest.head<2>().squaredNorm();
    if (rest2 <= 0) {
      chord.leave = chord.enter;
      return chord;
    }
    const double half = std::sqrt(rest2 / across2);
    chord.enter = middle - half;
    chord.leave = middle + half;
    for (const bool entering : {true, false}) {
      const Vector3d x = origin + (entering ? chord.enter : chord.leave) * direction;
      (entering ? chord.enter_normal : chord.leave_normal) =
          Vector3d(x.x() / shape.radius, x.y() / shape.radius, 0);
    }
  } else if (origin.head<2>().squaredNorm() >= shape.radius * shape.radius) {
    chord.leave = chord.enter;
    return chord;
  }
  cut_by_slab(chord, origin, direction, 2, 0.5 * shape.height);
  return chord;
}

Chord chord_of(const Shape& shape, const Vector3d& origin, const Vector3d& direction) {
  if (const auto* box = std::get_if<BoxShape>(&shape)) {
    return box_chord(0.5 * box->size, origin, direction);
  }
  if (const auto* room = std::get_if<RoomShape>(&shape)) {
    return box_chord(0.5 * room->size, origin, direction);
  }
  if (const auto* sphere = std::get_if<SphereShape>(&shape)) {
    return sphere_chord(sphere->radius, origin, direction);
  }
  if (const auto* cylinder = std::get_if<CylinderShape>(&shape)) {
    return cylinder_chord(*cylinder, origin, direction);
  }
  fail("a mesh has no closed form; ask the scene instead");
}

// Of a product of convex sets, from the excess over each of its bounds.
template <typename Excess>
double distance_from_excess(const Excess& excess) {
  return excess.cwiseMax(0).matrix().norm() + std::min(0.0, excess.maxCoeff());
}

void require_size(double size, const char* what) {
  require(std::isfinite(size) && size > 0 && size < 1e4,
          "a shape's ",
          what,
          " must lie above 0 and below 10 km, but is ",
          size,
          " m");
}

}  // namespace

std::optional<ShapeHit> intersect_shape(const Shape& shape,
                                        const Vector3d& origin,
                                        const Vector3d& direction,
                                        double nearest) {
  const Chord chord = chord_of(shape, origin, direction);
  if (chord.empty() || chord.leave < nearest) return std::nullopt;
  if (chord.enter >= nearest) return ShapeHit{chord.enter, chord.enter_normal};
  return ShapeHit{chord.leave, chord.leave_normal};
}

double signed_distance(const Shape& shape, const Vector3d& x) {
  if (const auto* sphere = std::get_if<SphereShape>(&shape)) return x.norm() - sphere->radius;
  if (const auto* cylinder = std::get_if<CylinderShape>(&shape)) {
    const Eigen::Array2d excess(x.head<2>().norm() - cylinder->radius,
                                std::abs(x.z()) - 0.5 * cylinder->height);
    return distance_from_excess(excess);
  }
  return distance_from_excess((x.cwiseAbs() - half_extent(shape)).array().eval());
}

Vector3d half_extent(const Shape& shape) {
  if (const auto* box = std::get_if<BoxShape>(&shape)) return 0.5 * box->size;
  if (const auto* room = std::get_if<RoomShape>(&shape)) return 0.5 * room->size;
  if (const auto* sphere = std::get_if<SphereShape>(&shape)) {
    return Vector3d::Constant(sphere->radius);
  }
  if (const auto* cylinder = std::get_if<CylinderShape>(&shape)) {
    return {cylinder->radius, cylinder->radius, 0.5 * cylinder->height};
  }
  fail("a mesh has no closed form; ask the scene instead");
}

void check_shape(const Shape& shape) {
  if (const auto* sphere = std::get_if<SphereShape>(&shape)) {
    require_size(sphere->radius, "radius");
  } else if (const auto* cylinder = std::get_if<CylinderShape>(&shape)) {
    require_size(cylinder->radius, "radius");
    require_size(cylinder->height, "height");
  } else if (const auto* mesh = std::get_if<MeshShape>(&shape)) {
    require(!mesh->mesh.empty(), "a scene's mesh needs at least one triangle, but has none");
    mesh->mesh.check();
  } else {
    for (const double edge : half_extent(shape)) require_size(2 * edge, "edge length");
  }
}

}  // namespace facula
