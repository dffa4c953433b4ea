// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/known_sigma.hpp>
#include <facula/reconstruct/filter/normals.hpp>
#include <facula/reconstruct/mesh/range_surface.hpp>

#include <algorithm>
#include <cmath>

namespace facula {
namespace {

/// A triangle, and a normal, need three.
bool has_three_points(const PointCloud& cloud) {
  return std::count_if(cloud.points.begin(), cloud.points.end(), [](const auto& p) {
           return p.allFinite();
         }) >= 3;
}

/// Towards the sensor where its place is known, else along the normal.
SightLines sight_lines(const PointCloud& cloud) {
  const bool seen = !cloud.sensor_origin.empty();
  SightLines sight;
  sight.toward.assign(cloud.size(), Eigen::Vector3f::Zero());
  sight.distance.assign(cloud.size(), 1.0F);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (!cloud.points[i].allFinite()) continue;
    const Eigen::Vector3f way =
        seen ? Eigen::Vector3f(cloud.sensor_origin[i] - cloud.points[i]) : cloud.normals[i];
    const float length = way.norm();
    if (!std::isfinite(length) || length < 1e-12F) continue;
    sight.toward[i] = way / length;
    if (seen) sight.distance[i] = length;
  }
  return sight;
}

void turn_into_world(RangeSurface& surface, const RigidTransform& world_from_scan) {
  const Eigen::Matrix3d rotation = world_from_scan.rotation.toRotationMatrix();
  for (SightVertex& vertex : surface.vertices) {
    vertex.point =
        (rotation * vertex.point.cast<double>() + world_from_scan.translation).cast<float>();
    vertex.toward = (rotation * vertex.toward.cast<double>()).cast<float>();
  }
}

}  // namespace

float sigma_weight(const PointCloud& cloud, std::size_t point) {
  constexpr float kUnit = 1e-3F;
  constexpr float kLeast = 1e-6F;  // a micrometre: no point may outweigh all others
  if (cloud.sigma.empty()) return 1;
  const float sigma = cloud.sigma[point];
  if (!is_known_sigma(sigma)) return 1;
  const float ratio = kUnit / std::max(sigma, kLeast);
  return ratio * ratio;
}

RangeSurface range_surface(const PosedCloud& scan, const RangeSurfaceOptions& options) {
  scan.cloud.check();
  require(scan.world_from_scan.matrix().allFinite(),
          "the pose of scan '",
          scan.name,
          "' holds a number that is not finite; register the scan or leave it out");
  if (!has_three_points(scan.cloud)) {
    return {.vertices = {}, .triangles = {}, .step = 0, .skipped_points = scan.cloud.size()};
  }
  const bool gridded = !scan.grid.empty();
  RangeSurface surface;
  if (scan.cloud.normals.empty() && (!gridded || scan.cloud.sensor_origin.empty())) {
    PosedCloud with_normals = scan;
    estimate_normals(with_normals.cloud, {.neighbours = 20, .num_threads = options.num_threads});
    const SightLines sight = sight_lines(with_normals.cloud);
    surface = gridded ? surface_of_grid(with_normals, sight, options)
                      : surface_of_points(with_normals, sight);
  } else {
    const SightLines sight = sight_lines(scan.cloud);
    surface = gridded ? surface_of_grid(scan, sight, options) : surface_of_points(scan, sight);
  }
  turn_into_world(surface, scan.world_from_scan);
  return surface;
}

}  // namespace facula
