// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/simulate/mesh_query.hpp>
#include <facula/acquire/simulate/triangle_distance.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include <embree3/rtcore.h>

namespace facula {
namespace {

using Eigen::Vector3d;

// Embree prunes its tree with a float copy of the query point: the radius carries that much more.
constexpr double kPadding = 1e-5;   // [m]
constexpr double kRelative = 1e-6;  // [1]

// Embree hands its context through to the filter.
struct CrossingCount {
  RTCIntersectContext context;  // first, so that a pointer to it is a pointer to the whole
  int count = 0;
};

void count_crossing(const RTCFilterFunctionNArguments* arguments) {
  ++reinterpret_cast<CrossingCount*>(arguments->context)->count;
  arguments->valid[0] = 0;
}

int count_crossings(RTCScene scene, const Vector3d& x, const Vector3d& direction) {
  CrossingCount crossings;
  rtcInitIntersectContext(&crossings.context);
  crossings.context.filter = count_crossing;
  RTCRayHit ray{};
  ray.ray.org_x = static_cast<float>(x.x());
  ray.ray.org_y = static_cast<float>(x.y());
  ray.ray.org_z = static_cast<float>(x.z());
  ray.ray.dir_x = static_cast<float>(direction.x());
  ray.ray.dir_y = static_cast<float>(direction.y());
  ray.ray.dir_z = static_cast<float>(direction.z());
  ray.ray.tfar = std::numeric_limits<float>::infinity();
  ray.ray.mask = ~0U;
  ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(scene, &crossings.context, &ray);
  return crossings.count;
}

}  // namespace

struct MeshQuery::Impl {
  std::vector<Vector3d> vertices;
  std::vector<TriangleMesh::Triangle> triangles;
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;

  void build();

  std::array<Vector3d, 3> corners(unsigned triangle) const {
    const TriangleMesh::Triangle& t = triangles[triangle];
    return {vertices[t[0]], vertices[t[1]], vertices[t[2]]};
  }
};

namespace {

template <typename Mesh>
struct NearestTriangle {
  const Mesh* mesh = nullptr;
  Vector3d x;
  double distance = std::numeric_limits<double>::infinity();

  static bool measure(RTCPointQueryFunctionArguments* arguments) {
    auto& nearest = *static_cast<NearestTriangle*>(arguments->userPtr);
    const auto corners = nearest.mesh->corners(arguments->primID);
    const double distance = distance_to_triangle(corners, nearest.x);
    if (!(distance < nearest.distance)) return false;
    nearest.distance = distance;
    const double padding = kPadding + kRelative * nearest.x.cwiseAbs().maxCoeff();
    arguments->query->radius = static_cast<float>(distance * (1 + kRelative) + padding);
    return true;
  }
};

}  // namespace

void MeshQuery::Impl::build() {
  device = rtcNewDevice("threads=1");
  require(device != nullptr, "the ray tracer Embree could not be started");
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* corner = static_cast<float*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), vertices.size()));
  auto* index = static_cast<unsigned*>(rtcSetNewGeometryBuffer(geometry,
                                                               RTC_BUFFER_TYPE_INDEX,
                                                               0,
                                                               RTC_FORMAT_UINT3,
                                                               3 * sizeof(unsigned),
                                                               triangles.size()));
  require(corner != nullptr && index != nullptr, "there is no memory for a scene's mesh");
  for (const Vector3d& vertex : vertices) {
    for (const double coordinate : vertex) *corner++ = static_cast<float>(coordinate);
  }
  for (const TriangleMesh::Triangle& triangle : triangles) {
    index = std::copy(triangle.begin(), triangle.end(), index);
  }
  rtcCommitGeometry(geometry);
  scene = rtcNewScene(device);
  rtcSetSceneFlags(
      scene,
      static_cast<RTCSceneFlags>(RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION));
  rtcAttachGeometry(scene, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(scene);
  require(rtcGetDeviceError(device) == RTC_ERROR_NONE,
          "the ray tracer Embree could not take the mesh in");
}

MeshQuery::MeshQuery(std::vector<Vector3d> vertices, std::vector<TriangleMesh::Triangle> triangles)
    : impl_(std::make_unique<Impl>()) {
  impl_->vertices = std::move(vertices);
  impl_->triangles = std::move(triangles);
  impl_->build();
}

MeshQuery::~MeshQuery() {
  if (impl_->scene != nullptr) rtcReleaseScene(impl_->scene);
  if (impl_->device != nullptr) rtcReleaseDevice(impl_->device);
}

double MeshQuery::distance(const Vector3d& x) const {
  NearestTriangle<Impl> nearest;
  nearest.mesh = impl_.get();
  nearest.x = x;
  RTCPointQuery query{};
  query.x = static_cast<float>(x.x());
  query.y = static_cast<float>(x.y());
  query.z = static_cast<float>(x.z());
  query.radius = std::numeric_limits<float>::infinity();
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  rtcPointQuery(impl_->scene, &query, &context, NearestTriangle<Impl>::measure, &nearest);
  return nearest.distance;
}

// Three rays vote, as one may run through an edge and be counted twice.
bool MeshQuery::inside(const Vector3d& x) const {
  int odd = 0;
  for (const Vector3d& direction : {Vector3d(0.267, 0.535, 0.802),
                                    Vector3d(-0.688, 0.229, 0.688),
                                    Vector3d(0.391, -0.911, -0.130)}) {
    odd += count_crossings(impl_->scene, x, direction) % 2;
  }
  return odd >= 2;
}

}  // namespace facula
