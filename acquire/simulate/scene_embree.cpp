// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/simulate/mesh_query.hpp>
#include <facula/acquire/simulate/scene.hpp>
#include <facula/acquire/simulate/shape_geometry.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include <embree3/rtcore.h>

namespace facula {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kSkip = 1e-6;      // surfaces nearer than this to a ray's ends do not count [m]
constexpr double kPadding = 1e-5;   // Embree walks its tree in float: boxes grow by this [m] ...
constexpr double kRelative = 1e-6;  // ... and by this share of their distance from the origin [1]

// Embree hands its context through to the callbacks: this one carries the ray in double precision
// there and the best hit back.
struct PreciseRay {
  RTCIntersectContext context;  // first, so that a pointer to it is a pointer to the whole
  Vector3d origin;
  Vector3d direction;
  double nearest = kSkip;
  double farthest = std::numeric_limits<double>::infinity();  // shrinks to the best hit
  Vector3d normal = Vector3d::Zero();                         // outwards, world frame
};

// What the callbacks know of an object.
struct Body {
  const Shape* shape = nullptr;
  Matrix3d object_from_world;
  Matrix3d world_from_object;
  Vector3d centre;                 // [m]
  std::vector<Vector3d> vertices;  // of a mesh, world frame [m]
  const std::vector<TriangleMesh::Triangle>* triangles = nullptr;
  std::unique_ptr<MeshQuery> query;  // of a mesh

  bool is_mesh() const { return triangles != nullptr; }
  Vector3d in_object(const Vector3d& x) const { return object_from_world * (x - centre); }
  std::array<Vector3d, 3> corners(unsigned triangle) const {
    const TriangleMesh::Triangle& t = (*triangles)[triangle];
    return {vertices[t[0]], vertices[t[1]], vertices[t[2]]};
  }
};

PreciseRay& precise(RTCIntersectContext* context) {
  return *reinterpret_cast<PreciseRay*>(context);
}

float rounded_up(double value) {
  return std::nextafter(static_cast<float>(value), std::numeric_limits<float>::infinity());
}

void bound_body(const RTCBoundsFunctionArguments* arguments) {
  const Body& body = *static_cast<const Body*>(arguments->geometryUserPtr);
  const Vector3d half = body.world_from_object.cwiseAbs() * half_extent(*body.shape);
  const Vector3d pad = Vector3d::Constant(kPadding) + kRelative * (body.centre.cwiseAbs() + half);
  const Vector3d low = body.centre - half - pad;
  const Vector3d high = body.centre + half + pad;
  RTCBounds& bounds = *arguments->bounds_o;
  bounds.lower_x = static_cast<float>(low.x());
  bounds.lower_y = static_cast<float>(low.y());
  bounds.lower_z = static_cast<float>(low.z());
  bounds.upper_x = static_cast<float>(high.x());
  bounds.upper_y = static_cast<float>(high.y());
  bounds.upper_z = static_cast<float>(high.z());
}

std::optional<ShapeHit> hit_body(const Body& body, const PreciseRay& ray) {
  return intersect_shape(
      *body.shape, body.in_object(ray.origin), body.object_from_world * ray.direction, ray.nearest);
}

void intersect_body(const RTCIntersectFunctionNArguments* arguments) {
  if (arguments->valid[0] == 0) return;
  const Body& body = *static_cast<const Body*>(arguments->geometryUserPtr);
  PreciseRay& ray = precise(arguments->context);
  const std::optional<ShapeHit> hit = hit_body(body, ray);
  if (!hit || !(hit->distance < ray.farthest)) return;
  ray.farthest = hit->distance;
  ray.normal = body.world_from_object * hit->normal;
  auto& out = *reinterpret_cast<RTCRayHit*>(arguments->rayhit);
  out.ray.tfar = rounded_up(hit->distance);
  out.hit.geomID = arguments->geomID;
  out.hit.primID = arguments->primID;
}

void occlude_body(const RTCOccludedFunctionNArguments* arguments) {
  if (arguments->valid[0] == 0) return;
  const Body& body = *static_cast<const Body*>(arguments->geometryUserPtr);
  const PreciseRay& ray = precise(arguments->context);
  const std::optional<ShapeHit> hit = hit_body(body, ray);
  if (!hit || !(hit->distance < ray.farthest)) return;
  reinterpret_cast<RTCRay*>(arguments->ray)->tfar = -std::numeric_limits<float>::infinity();
}

// Embree says which triangle is hit; where, is worked out again in double precision.
double distance_to_triangle_plane(const std::array<Vector3d, 3>& corners,
                                  const PreciseRay& ray,
                                  Vector3d& normal) {
  normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalized();
  return normal.dot(corners[0] - ray.origin) / normal.dot(ray.direction);
}

void filter_nearest_triangle(const RTCFilterFunctionNArguments* arguments) {
  const Body& body = *static_cast<const Body*>(arguments->geometryUserPtr);
  PreciseRay& ray = precise(arguments->context);
  const auto& hit = *reinterpret_cast<const RTCHit*>(arguments->hit);
  Vector3d normal;
  const double distance = distance_to_triangle_plane(body.corners(hit.primID), ray, normal);
  if (distance >= ray.nearest && distance < ray.farthest) {
    ray.farthest = distance;
    ray.normal = normal;
  } else {
    arguments->valid[0] = 0;
  }
}

void filter_any_triangle(const RTCFilterFunctionNArguments* arguments) {
  const Body& body = *static_cast<const Body*>(arguments->geometryUserPtr);
  const PreciseRay& ray = precise(arguments->context);
  const auto& hit = *reinterpret_cast<const RTCHit*>(arguments->hit);
  Vector3d normal;
  const double distance = distance_to_triangle_plane(body.corners(hit.primID), ray, normal);
  if (!(distance >= ray.nearest && distance < ray.farthest)) arguments->valid[0] = 0;
}

RTCRay embree_ray(const PreciseRay& ray) {
  RTCRay result{};
  result.org_x = static_cast<float>(ray.origin.x());
  result.org_y = static_cast<float>(ray.origin.y());
  result.org_z = static_cast<float>(ray.origin.z());
  result.dir_x = static_cast<float>(ray.direction.x());
  result.dir_y = static_cast<float>(ray.direction.y());
  result.dir_z = static_cast<float>(ray.direction.z());
  result.tnear = 0;  // the callbacks know the true ends
  result.tfar = rounded_up(ray.farthest * (1 + kRelative) + kPadding);
  result.mask = ~0U;
  return result;
}

PreciseRay precise_ray(const Vector3d& origin, const Vector3d& direction) {
  PreciseRay ray;
  rtcInitIntersectContext(&ray.context);
  ray.origin = origin;
  ray.direction = direction;
  return ray;
}

Body make_body(const SceneObject& object) {
  Body body;
  body.shape = &object.shape;
  body.world_from_object = object.world_from_object.rotation.toRotationMatrix();
  body.object_from_world = body.world_from_object.transpose();
  body.centre = object.world_from_object.translation;
  if (const auto* mesh = std::get_if<MeshShape>(&object.shape)) {
    body.triangles = &mesh->mesh.triangles;
    for (const Eigen::Vector3f& vertex : mesh->mesh.vertices) {
      body.vertices.emplace_back(object.world_from_object * vertex.cast<double>());
    }
    body.query = std::make_unique<MeshQuery>(body.vertices, *body.triangles);
  }
  return body;
}

}  // namespace

struct Scene::Impl {
  std::vector<SceneObject> objects;
  std::vector<Body> bodies;
  RTCDevice device = nullptr;
  RTCScene all = nullptr;

  explicit Impl(std::vector<SceneObject> given) : objects(std::move(given)) {}
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  ~Impl() {
    if (all != nullptr) rtcReleaseScene(all);
    if (device != nullptr) rtcReleaseDevice(device);
  }

  void build();
  RTCGeometry new_shape_geometry(Body& body) const;
  RTCGeometry new_mesh_geometry(Body& body) const;
};

RTCGeometry Scene::Impl::new_shape_geometry(Body& body) const {
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(geometry, 1);
  rtcSetGeometryUserData(geometry, &body);
  rtcSetGeometryBoundsFunction(geometry, bound_body, nullptr);
  rtcSetGeometryIntersectFunction(geometry, intersect_body);
  rtcSetGeometryOccludedFunction(geometry, occlude_body);
  rtcCommitGeometry(geometry);
  return geometry;
}

RTCGeometry Scene::Impl::new_mesh_geometry(Body& body) const {
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(geometry,
                                                               RTC_BUFFER_TYPE_VERTEX,
                                                               0,
                                                               RTC_FORMAT_FLOAT3,
                                                               3 * sizeof(float),
                                                               body.vertices.size()));
  auto* triangles = static_cast<unsigned*>(rtcSetNewGeometryBuffer(geometry,
                                                                   RTC_BUFFER_TYPE_INDEX,
                                                                   0,
                                                                   RTC_FORMAT_UINT3,
                                                                   3 * sizeof(unsigned),
                                                                   body.triangles->size()));
  require(vertices != nullptr && triangles != nullptr, "there is no memory for a scene's mesh");
  for (const Vector3d& vertex : body.vertices) {
    for (const double coordinate : vertex) *vertices++ = static_cast<float>(coordinate);
  }
  for (const TriangleMesh::Triangle& triangle : *body.triangles) {
    triangles = std::copy(triangle.begin(), triangle.end(), triangles);
  }
  rtcSetGeometryUserData(geometry, &body);
  rtcSetGeometryIntersectFilterFunction(geometry, filter_nearest_triangle);
  rtcSetGeometryOccludedFilterFunction(geometry, filter_any_triangle);
  rtcCommitGeometry(geometry);
  return geometry;
}

void Scene::Impl::build() {
  device = rtcNewDevice("threads=1");
  require(device != nullptr, "the ray tracer Embree could not be started");
  all = rtcNewScene(device);
  rtcSetSceneFlags(all, RTC_SCENE_FLAG_ROBUST);
  for (const SceneObject& object : objects) bodies.push_back(make_body(object));
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    Body& body = bodies[i];
    RTCGeometry geometry = body.is_mesh() ? new_mesh_geometry(body) : new_shape_geometry(body);
    rtcAttachGeometryByID(all, geometry, static_cast<unsigned>(i));
    rtcReleaseGeometry(geometry);
  }
  rtcCommitScene(all);
  require(rtcGetDeviceError(device) == RTC_ERROR_NONE,
          "the ray tracer Embree could not take the scene in");
}

Scene::Scene(std::vector<SceneObject> objects) {
  for (const SceneObject& object : objects) check_object(object);
  impl_ = std::make_unique<Impl>(std::move(objects));
  impl_->build();
}

Scene::~Scene() = default;
Scene::Scene(Scene&&) noexcept = default;
Scene& Scene::operator=(Scene&&) noexcept = default;

const std::vector<SceneObject>& Scene::objects() const {
  return impl_->objects;
}

std::optional<SceneHit> Scene::first_hit(const Vector3d& origin, const Vector3d& direction) const {
  PreciseRay ray = precise_ray(origin, direction);
  RTCRayHit out{};
  out.ray = embree_ray(ray);
  out.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(impl_->all, &ray.context, &out);
  if (out.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
  SceneHit hit;
  hit.distance = ray.farthest;
  hit.point = origin + ray.farthest * direction;
  hit.normal = ray.normal.dot(direction) > 0 ? Vector3d(-ray.normal) : ray.normal;
  hit.object = out.hit.geomID;
  return hit;
}

bool Scene::occluded(const Vector3d& from, const Vector3d& to) const {
  const Vector3d way = to - from;
  const double length = way.norm();
  if (length <= 2 * kSkip) return false;
  PreciseRay ray = precise_ray(from, way / length);
  ray.farthest = length - kSkip;
  RTCRay out = embree_ray(ray);
  rtcOccluded1(impl_->all, &ray.context, &out);
  return out.tfar < 0;
}

double Scene::distance(const Vector3d& x_in_world) const {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Body& body : impl_->bodies) {
    const double distance =
        body.is_mesh() ? body.query->distance(x_in_world)
                       : std::abs(signed_distance(*body.shape, body.in_object(x_in_world)));
    nearest = std::min(nearest, distance);
  }
  return nearest;
}

bool Scene::inside(const Vector3d& x_in_world) const {
  return std::any_of(impl_->bodies.begin(), impl_->bodies.end(), [&](const Body& body) {
    if (body.is_mesh()) return body.query->inside(x_in_world);
    const double signed_to_surface = signed_distance(*body.shape, body.in_object(x_in_world));
    const bool is_room = std::holds_alternative<RoomShape>(*body.shape);
    return is_room ? signed_to_surface > 0 : signed_to_surface < 0;
  });
}

}  // namespace facula
